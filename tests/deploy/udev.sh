#!/usr/bin/env bash
# What udev makes of a RoboClaw, an FTDI adapter, a pulse and a GPIO chip that are made up by umockdev: names, rights, latency.
set -uo pipefail
PATH=$PATH:/usr/sbin:/sbin
for program in udevadm umockdev-run; do
    command -v $program >/dev/null || { echo "skipped: $program is not installed"; exit 77; }
done
unshare -rm true 2>/dev/null || { echo "skipped: there is no namespace of users"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
hub=/devices/platform/soc/1c14400.usb/usb2/2-1
claw=$hub/2-1.1/2-1.1:1.0/tty/ttyACM0
adapter=$hub/2-1.2/2-1.2:1.1/ttyUSB1
line=/devices/platform/serial/tty/ttyS1
pulse=/devices/virtual/pps/pps0
chip=/devices/platform/soc/1c20800.pinctrl/gpiochip0
dialout=$(getent group dialout | cut -d: -f3)

device() { # PATH, then a line each
    printf 'P: %s\n' "$1"
    printf '%s\n' "${@:2}" ''
}
node() { # PATH SUBSYSTEM MAJOR:MINOR, then a line each
    device "$1" "N: ${1##*/}" "E: DEVNAME=/dev/${1##*/}" "E: SUBSYSTEM=$2" "E: MAJOR=${3%:*}" "E: MINOR=${3#*:}" "A: dev=$3\\n" "${@:4}"
}
{
    device /devices/platform/soc/1c14400.usb "E: SUBSYSTEM=platform"
    for path in ${hub%/*} $hub; do
        device "$path" "E: DEVTYPE=usb_device" "E: SUBSYSTEM=usb"
    done
    device $hub/2-1.1 "E: DEVTYPE=usb_device" "E: SUBSYSTEM=usb" 'A: idVendor=03eb\n' 'A: idProduct=2404\n'
    device $hub/2-1.1/2-1.1:1.0 "E: DEVTYPE=usb_interface" "E: SUBSYSTEM=usb" 'A: bInterfaceClass=02\n' 'A: bInterfaceNumber=00\n'
    node $claw tty 166:0
    device $hub/2-1.2 "E: DEVTYPE=usb_device" "E: SUBSYSTEM=usb" 'A: idVendor=0403\n' 'A: idProduct=6011\n'
    device $hub/2-1.2/2-1.2:1.1 "E: DEVTYPE=usb_interface" "E: SUBSYSTEM=usb" 'A: bInterfaceClass=ff\n' 'A: bInterfaceNumber=01\n'
    device $adapter "E: SUBSYSTEM=usb-serial" "L: driver=../../../../../../../../../../bus/usb-serial/drivers/ftdi_sio" \
        'A: latency_timer=16\n' 'A: port_number=0\n'
    node $adapter/tty/ttyUSB1 tty 188:1 "L: device=../../../ttyUSB1"
    node $line tty 4:65
    node $pulse pps 250:0
    device ${chip%/*} "E: SUBSYSTEM=platform"
    node $chip gpio 254:0
} >"$work/devices"

mkdir -p "$work/dev/pts"
touch "$work/dev/null"
ln -s pts/ptmx "$work/dev/ptmx"
says() { # DEVICE; udevadm makes links in /dev and notes in /run, so it has some of its own
    # shellcheck disable=SC2016
    unshare -rm bash -c 'mount --bind "$1" /etc/udev/rules.d && mount -t tmpfs tmpfs /run &&
        mount --bind /dev/null "$2/dev/null" && mount -t devpts -o newinstance,ptmxmode=0666 devpts "$2/dev/pts" &&
        mount --rbind "$2/dev" /dev && TMPDIR=$2 umockdev-run -d "$2/devices" -- udevadm test --action=add "/sys$3"' sh "$rules" "$work" "$1" 2>&1 |
        grep -v "^Reading rules file\|^Trying to open"
}
failed=0
expect() { # DEVICE, PATTERN of a line that udev says
    says "$1" >"$work/said"
    grep -q -- "$2" "$work/said" || { echo "FAILED ${1##*/}: expected \"$2\" in:"; cat "$work/said"; failed=1; }
}

rules=$HERMES_SOURCE/deploy/udev
expect $claw "LINK 'hermes/roboclaw-platform-1c14400.usb-usb-0:1.1:1.0'"
expect $claw "^ID_MM_PORT_IGNORE=1"
expect $claw "60-hermes.rules:[0-9]* MODE 0660"
expect $adapter/tty/ttyUSB1 "LINK 'hermes/serial-platform-1c14400.usb-usb-0:1.2:1.1-port0'"
expect $adapter/tty/ttyUSB1 "latency_timer' writing '1'"
expect $pulse "60-hermes.rules:[0-9]* MODE 0660"
expect $chip "60-hermes.rules:[0-9]* GROUP $dialout\$"
expect $chip "60-hermes.rules:[0-9]* MODE 0660"
for device in $claw $adapter/tty/ttyUSB1 $line $pulse $chip; do
    says "$device" | grep "^/etc/udev/rules.d/60-hermes.rules:" && { echo "FAILED: udev does not understand the rules"; failed=1; }
done
says $line | grep "LINK 'hermes/" && { echo "FAILED: a line of the board has a name of USB"; failed=1; }

# And udev tells what it does not understand.
rules=$work/spoilt
mkdir "$rules"
sed 's/MODE="0660"/MOD="0660"/' "$HERMES_SOURCE/deploy/udev/60-hermes.rules" >"$rules/60-hermes.rules"
expect $pulse "60-hermes.rules:[0-9]* Invalid key 'MOD'"
[ $failed -eq 0 ] && echo "names, rights and latency are as expected"
exit $failed
