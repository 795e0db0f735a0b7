#!/bin/sh
# other_projects.sh SOURCE SCRATCH: the example as a program of other projects: one that has roadpose in a folder of its own,
# one that installs it without its programs to unusual folders, one that cross-compiles with a toolchain that is not ours.
# Paths have blanks, nothing is as our own builds have it.
set -eu
source=$1
scratch=$2
main=$source/port/example/main.c

rm -rf "$scratch"
mkdir -p "$scratch/parent" "$scratch/cross"

quietly() {
    "$@" >"$scratch/log.txt" 2>&1 || { echo "failed: $*"; tail -n 40 "$scratch/log.txt"; exit 1; }
}

# A folder of a larger project, for which a warning of ours must not be an error.
cat >"$scratch/parent/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.20)
project(parent LANGUAGES C)
add_subdirectory("$source" roadpose)
add_executable(app "$main")
target_link_libraries(app PRIVATE roadpose::roadpose_camera_small roadpose::roadpose_can)
add_library(plugin SHARED "$main")
target_link_libraries(plugin PRIVATE roadpose::roadpose_camera roadpose::roadpose_can)
END
quietly cmake -S "$scratch/parent" -B "$scratch/parent/build" -G "Unix Makefiles" -DCMAKE_BUILD_TYPE=Debug \
    -DBUILD_SHARED_LIBS=ON -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DCMAKE_EXPORT_COMPILE_COMMANDS=ON
quietly cmake --build "$scratch/parent/build" --target app plugin
"$scratch/parent/build/app" | tee "$scratch/parent.txt" | grep -q '^ok: '
if grep -q -- -Werror "$scratch/parent/build/compile_commands.json"; then
    echo "a warning would stop the build of another project"
    exit 1
fi

# A packager's folders, without programs. An absolute one may not lie within the sources, says CMake.
elsewhere=$(mktemp -d)
trap 'rm -rf "$elsewhere"' EXIT
for include in unusual "$elsewhere/absolute include"; do
    installed="$scratch/installed"
    rm -rf "$installed"
    quietly cmake -S "$source" -B "$scratch/plain" -G Ninja -DROADPOSE_PORTS=OFF -DCMAKE_BUILD_TYPE=Debug \
        -DCMAKE_INSTALL_INCLUDEDIR="$include" -DCMAKE_INSTALL_LIBDIR=lib/unusual -DCMAKE_INSTALL_PREFIX="$installed"
    quietly cmake --build "$scratch/plain"
    quietly cmake --install "$scratch/plain"
    quietly cmake -S "$source/port/example" -B "$scratch/example" -G Ninja -Droadpose_DIR="$installed/lib/unusual/cmake/roadpose"
    quietly cmake --build "$scratch/example"
    "$scratch/example/example-small" | cmp - "$scratch/parent.txt"
    PKG_CONFIG_PATH=$installed/lib/unusual/pkgconfig
    export PKG_CONFIG_PATH
    eval "cc $(pkg-config --cflags roadpose-small) '$main' $(pkg-config --libs roadpose-small) -o '$scratch/by-pkg-config'"
    "$scratch/by-pkg-config" | cmp - "$scratch/parent.txt"
done

# A product's own toolchain file, without an operating system: the libraries, and no board of ours.
cat >"$scratch/cross/toolchain.cmake" <<END
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR cortex-r5)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_C_FLAGS_INIT -mcpu=cortex-r5)
END
quietly cmake -S "$source" -B "$scratch/cross/build" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$scratch/cross/toolchain.cmake"
quietly cmake --build "$scratch/cross/build"
quietly cmake --install "$scratch/cross/build" --prefix "$scratch/cross/installed"
[ -f "$scratch/cross/installed/lib/libroadpose_can.a" ]
echo "other projects build it as a folder, from unusual places and with a toolchain of their own"
