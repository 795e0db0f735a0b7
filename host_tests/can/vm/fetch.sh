#!/bin/sh
# Fetches into the folder $1, from Debian's archive, what the virtual machine is made of; installs nothing.
#   $1/vmlinuz      the kernel            $1/modules/*.ko    CAN, a virtual interface, one on a serial line; in the order of
#                                                            loading
#   $1/busybox      the only userland     $1/candump, $1/cansend
# Packages: linux-image-amd64 (what it depends on), busybox-static, can-utils.
set -eu

folder=$1
script=$(cd "$(dirname "$0")" && pwd)/$(basename "$0")
if cmp -s "$script" "$folder/complete"; then exit 0; fi # by this very script
rm -rf "$folder"
mkdir -p "$folder/modules" "$folder/packages"
cd "$folder/packages"

newest_kernel() {
    apt-cache depends linux-image-amd64 2>/dev/null |
        sed -n 's/.*Depends: \(linux-image-[0-9][^ ]*-amd64\).*/\1/p' | head -n 1
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

kernel=$(newest_kernel)
if [ -z "$kernel" ]; then # a fresh machine knows no packages yet
    as_root apt-get -q update
    kernel=$(newest_kernel)
fi
[ -n "$kernel" ] || { echo "fetch.sh: apt knows no linux-image-amd64" >&2; exit 1; }
apt-get -q -o APT::Sandbox::User=root download "$kernel" busybox-static can-utils

# Only what is needed: the whole image would be 400 MB.
unpack() {
    dpkg-deb --fsys-tarfile "$1"_*.deb | tar -x -C "$folder/packages" --wildcards "$2"
}
unpack "$kernel" './boot/vmlinuz-*'
unpack "$kernel" './lib/modules/*can*'
unpack busybox-static './bin/busybox'
unpack can-utils './usr/bin/can*'

cp boot/vmlinuz-* "$folder/vmlinuz"
cp bin/busybox usr/bin/candump usr/bin/cansend "$folder"
number=0
for module in net/can/can net/can/can-raw drivers/net/can/dev/can-dev drivers/net/can/vcan drivers/net/can/slcan/slcan; do
    number=$((number + 1))
    found=$(find lib/modules -path "*/kernel/$module.ko*" | head -n 1)
    [ -n "$found" ] || { echo "fetch.sh: the kernel has no module $module" >&2; exit 1; }
    target=$folder/modules/$number-$(basename "$module").ko
    case $found in
    *.xz) xz -dc "$found" >"$target" ;;
    *) cp "$found" "$target" ;;
    esac
done
cd "$folder"
rm -rf "$folder/packages"
cp "$script" "$folder/complete"
