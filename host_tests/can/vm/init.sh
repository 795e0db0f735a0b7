#!/busybox sh
# First process of the virtual machine: loads CAN, drives in a network namespace as a host would, sends the results through
# the second serial port, powers off.
/busybox mkdir -p /bin /proc /sys /dev /tmp /output
/busybox --install -s /bin
export PATH=/bin
mount -t proc none /proc
mount -t sysfs none /sys
mount -t devtmpfs none /dev
mkdir -p /dev/pts
mount -t devpts none /dev/pts
for module in /modules/*.ko; do
    insmod "$module" || echo "init: cannot load $module"
done
unshare -n sh /drive.sh /roadpose-replay /candump /drive /output steady down_and_up missing_at_first removed_and_back
sh /drive.sh /roadpose-replay /candump /drive /output full # Linux makes this interface outside of any namespace
stty -F /dev/ttyS1 raw
tar -c -f - -C /output . >/dev/ttyS1
sync
echo "init: finished"
poweroff -f
