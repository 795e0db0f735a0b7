#!/bin/sh
# installed_package.sh SOURCE BUILD SCRATCH: builds the example project as other projects would. Installs a build, moves it elsewhere, and builds and runs the example project with
# its CMake package and with its pkg-config files, as another project would.
set -eu
source=$1
build=$2
scratch=$3

rm -rf "$scratch"
mkdir -p "$scratch"
cmake --install "$build" --prefix "$scratch/first" >"$scratch/install.log"
mv "$scratch/first" "$scratch/moved" # nothing installed may know where it was

# The same pose and CAN frames from whichever way the program was built.
check_output() {
    if ! grep -q '^ok: pitch -\?[0-9]\{1,3\} urad, roll -\?[0-9]\{1,3\} urad, height 1[45][0-9]\{5\} um$' "$1" ||
        [ "$(grep -c '^3D[012]#' "$1")" -ne 3 ]; then
        echo "not what the example should say:"
        cat "$1"
        exit 1
    fi
}

cmake -S "$source/port/example" -B "$scratch/example" -G Ninja -DCMAKE_PREFIX_PATH="$scratch/moved" >"$scratch/configure.log"
cmake --build "$scratch/example" >"$scratch/build.log" || { cat "$scratch/build.log"; exit 1; }
for program in example example-small; do
    "$scratch/example/$program" >"$scratch/$program.txt"
    check_output "$scratch/$program.txt"
done
"$scratch/example/example-cxx"

PKG_CONFIG_PATH=$(dirname "$(find "$scratch/moved" -name roadpose.pc)")
export PKG_CONFIG_PATH
for package in roadpose roadpose-small; do
    # eval: pkg-config puts a backslash before each blank of a path
    eval "cc $(pkg-config --cflags "$package") '$source/port/example/main.c' $(pkg-config --libs "$package") -o '$scratch/by-$package'"
    "$scratch/by-$package" >"$scratch/by-$package.txt"
    check_output "$scratch/by-$package.txt"
done
cmp "$scratch/example.txt" "$scratch/by-roadpose.txt"
cmp "$scratch/example-small.txt" "$scratch/by-roadpose-small.txt"
"$scratch/moved/bin/roadpose-replay" --help >/dev/null
echo "the installed package works: CMake, pkg-config, C and C++"
