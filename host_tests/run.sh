#!/bin/sh
# Installs what is missing, builds roadpose, and runs every test. Needs Debian 12 and, to install, root or sudo.
#   sh host_tests/run.sh            everything
#   sh host_tests/run.sh -R unit    only the tests whose name matches (any options of ctest)
# Real drives are played too when ROADPOSE_RECORDINGS names a folder of recordings.
# Environment: ROADPOSE_BUILD_DIR (default build-host-tests), ROADPOSE_RECORDINGS, ROADPOSE_TEST_SEED.
set -eu

packages='gcc g++ libc6-dev cmake ninja-build clang-19 libclang-rt-19-dev libopencv-dev binutils bash python3 python3-venv qemu-system-x86 cpio ca-certificates'
# The same bits from a 32-bit build: only where the machine can run one. Not gcc-multilib, which excludes gcc-powerpc-linux-gnu.
[ "$(dpkg --print-architecture)" != amd64 ] || packages="$packages gcc-12-multilib libc6-dev-i386"
# Firmware: Cortex-M, RISC-V and big-endian PowerPC, all emulated; and the installed package.
packages="$packages gcc-arm-none-eabi libnewlib-arm-none-eabi gcc-riscv64-unknown-elf picolibc-riscv64-unknown-elf
    gcc-powerpc-linux-gnu libc6-dev-powerpc-cross qemu-user-static qemu-system-arm qemu-system-misc pkg-config make"

root=$(cd "$(dirname "$0")/.." && pwd)
build=${ROADPOSE_BUILD_DIR:-$root/build-host-tests}
case $build in /*) ;; *) build=$PWD/$build ;; esac

as_root() {
    if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

missing_packages() {
    for package in $packages; do
        dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || printf '%s ' "$package"
    done
}

install_packages() {
    missing=$(missing_packages)
    [ -n "$missing" ] || return 0
    echo "Installing: $missing"
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -q update
    # shellcheck disable=SC2086 # one argument a package is meant
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -y --no-install-recommends install $missing
}

# Prints the command that runs each failed test again, and the line that sums up.
sum_up() {
    report=$1
    failed=0
    if [ -f "$build/Testing/Temporary/LastTestsFailed.log" ]; then
        while IFS=: read -r _ name; do
            failed=$((failed + 1))
            echo "failed: $name    again: sh host_tests/run.sh -R '^$name\$'"
        done <"$build/Testing/Temporary/LastTestsFailed.log"
    fi
    passed=$(grep -c ' Passed ' "$report" || true)
    skipped=$(grep -c '\*\*\*Skipped' "$report" || true)
    echo "$passed passed, $failed failed, $skipped skipped"
}

run_tests() {
    report=$build/ctest.txt
    rm -f "$build/Testing/Temporary/LastTestsFailed.log"
    # The exit status of ctest must survive the pipe into tee.
    { ctest --test-dir "$build" --output-on-failure -j "$(nproc)" "$@" && echo 0 >"$build/ctest.status" ||
        echo $? >"$build/ctest.status"; } | tee "$report"
    sum_up "$report"
    return "$(cat "$build/ctest.status")"
}

install_packages
sh "$root/host_tests/cmake/unity_from_debian.sh" "$build/unity"
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DROADPOSE_HOST_TESTS=ON -DROADPOSE_PORTS=ON \
    -DROADPOSE_UNITY_DIR="$build/unity/src"
cmake --build "$build"
run_tests --no-tests=error "$@"
