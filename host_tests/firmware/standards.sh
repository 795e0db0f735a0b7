#!/bin/sh
# standards.sh SOURCE SCRATCH STANDARD COMPILER: library and programs build without a warning as C11 or C17; the warnings are
# those of the project, all of them errors.
set -eu
source=$1
scratch=$2/c$3-$(basename "$4")

cmake -S "$source" -B "$scratch" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_C_STANDARD="$3" -DCMAKE_C_COMPILER="$4" \
    -DROADPOSE_PORTS=ON -DCMAKE_EXPORT_COMPILE_COMMANDS=ON >/dev/null
grep -q -- "-Wall -Wextra -Wconversion -Wshadow -pedantic -Werror -std=c$3" "$scratch/compile_commands.json" ||
    { echo "not compiled as C$3 with all warnings"; exit 1; }
cmake --build "$scratch" -j 1
