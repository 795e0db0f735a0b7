#!/bin/sh
# The messages, the protection and both sides on a 32-bit big-endian machine (PowerPC, emulated): the bytes on the bus must
# not depend on the byte order of the processor.
#   big_endian.sh UNITY FOLDER     the sources of Unity, where to build
set -eu

unity=$1
folder=$2
project=$(cd "$(dirname "$0")/../.." && pwd)
mkdir -p "$folder"
for test in e2e messages transmit receive; do
    powerpc-linux-gnu-gcc -O2 -std=c99 -static -I"$project/include" -I"$unity" \
        "$project/host_tests/can/test_$test.c" "$project/host_tests/can/fake_bus.c" "$project"/port/can/*.c \
        "$unity/unity.c" -lm -o "$folder/$test"
    echo "again: sh $0 $unity $folder"
    qemu-ppc-static "$folder/$test"
done
