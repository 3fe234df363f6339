#!/usr/bin/env bash
# What the package's postinst and postrm do to the files of a system, which is a temporary folder: settings that are there stay, udev
# looks again at what is plugged in, and a purge leaves no file, also where disks are mounted.
set -uo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
fail() { echo "FAILED $1"; failed=1; }

# Programs that would change this system, or need the user hermes, do as much as can be done.
mkdir "$work/bin"
printf '#!/bin/sh\nexit 0\n' >"$work/bin/systemd-sysusers"
# shellcheck disable=SC2016
printf '#!/bin/sh\nexec %s $(echo " $* " | sed "s/ -o hermes -g hermes / /")\n' "$(command -v install)" >"$work/bin/install"
printf '#!/bin/sh\necho "$*" >>%s\n[ ! -e %s ]\n' "$work/udev" "$work/udev-fails" >"$work/bin/udevadm"
chmod +x "$work"/bin/*

fresh() { # a system before the package is configured
    rm -rf "$work/root"
    mkdir -p "$work/root/etc" "$work/root/var/lib" "$work/root/run/udev" "$work/root/usr/share/hermes"
    cp -r "$HERMES_SOURCE/deploy/settings" "$work/root/usr/share/hermes/settings"
    etc=$work/root/etc/hermes
    rm -f "$work"/udev*
}
run() { # SCRIPT ARGUMENT: as dpkg does, but for its folders
    sed "s,/\(etc/hermes\|var/lib/hermes\|usr/share/hermes\|run/\),$work/root/\1,g" \
        "$HERMES_SOURCE/deploy/debian/hermes-daemons.$1" >"$work/$1"
    grep "[ \"]/\(etc\|var\|run\)/" "$work/$1" && { echo "$1: expected that no folder of this system is in it"; exit 1; }
    PATH=$work/bin:$PATH sh "$work/$1" "$2" >"$work/said" 2>&1 || { fail "$1 $2: status $?"; cat "$work/said"; }
}

simulator=$HERMES_SOURCE/deploy/settings/simulator
fresh
run postinst configure
diff -r "$simulator" "$etc" || fail "a fresh system: expected the simulator's settings"

fresh
mkdir "$etc"
echo calibrated >"$etc/motorcontrol.json"
ln -s "$work/absent" "$etc/scanmatcher.json"
run postinst configure
[ "$(cat "$etc/motorcontrol.json")" = calibrated ] || fail "settings without a supervisor.json: they are replaced"
[ -L "$etc/scanmatcher.json" ] || fail "a link to a disk that is not mounted: it is replaced"
cmp "$simulator/supervisor.json" "$etc/supervisor.json" || fail "what is absent: expected the simulator's"

for supervisor in "cp $simulator/supervisor.json" "ln -s $work/absent"; do
    fresh
    mkdir "$etc"
    $supervisor "$etc/supervisor.json"
    run postinst configure
    [ "$(ls "$etc")" = supervisor.json ] || fail "a robot with a supervisor.json of its own: it got $(ls "$etc")"
done

fresh
run postinst configure
[ ! -e "$work/udev" ] || fail "a chroot: udev was asked for $(cat "$work/udev")"
udev_runs() { python3 -c "import socket, sys; socket.socket(socket.AF_UNIX).bind(sys.argv[1])" "$work/root/run/udev/control"; }
fresh && udev_runs
run postinst configure
[ "$(head -1 "$work/udev")" = "control --reload" ] || fail "udev runs: expected that it reads the rules first"
grep -q "^trigger --action=change .*--subsystem-match=tty" "$work/udev" || fail "udev runs: expected that it looks at serial lines again"
fresh && udev_runs && touch "$work/udev-fails"
run postinst configure
grep -q "/dev/hermes" "$work/said" || fail "udev does not answer: expected that it is told"

fresh
run postrm purge
run postinst configure
touch "$work/root/var/lib/hermes/map.csv"
run postrm remove
[ -e "$work/root/var/lib/hermes/map.csv" ] || fail "remove: the map is gone"
run postrm purge
[ ! -e "$etc" ] && [ ! -e "$work/root/var/lib/hermes" ] || fail "purge: expected nothing left"

# As fstab.hermes of the board: a disk for the state, which has the settings; the recordings are on another, which cannot be written to.
purge_disks() { # STATE ETC SCRIPT; says what is wrong
    mount -t tmpfs tmpfs "$1" && mkdir "$1/etc" "$1/maps" "$1/recordings" && mount --bind "$1/etc" "$2" &&
        mount -t tmpfs tmpfs "$1/recordings" && touch "$1/maps/map.csv" "$1/recordings/a" "$2/supervisor.json" &&
        mount -o remount,bind,ro "$1/recordings" || exit
    sh "$3" purge 2>"$3.told" && echo "expected a failure: recordings cannot be removed"
    grep -q "Read-only file system" "$3.told" || echo "expected the reason, found: $(cat "$3.told")"
    mount -o remount,bind,rw "$1/recordings" || exit
    [ -e "$1/recordings/a" ] || echo "expected that the recordings are there"
    sh "$3" purge 2>"$3.told" || echo "status $?: $(cat "$3.told")"
    find "$1" "$2" ! -type d
}
fresh
run postinst configure
if unshare -rm true 2>/dev/null; then
    export -f purge_disks
    # shellcheck disable=SC2016
    unshare -rm bash -c 'purge_disks "$@"' sh "$work/root/var/lib/hermes" "$etc" "$work/postrm" >"$work/said" 2>&1 || fail "purge: there are no disks"
    [ ! -s "$work/said" ] || { fail "purge of disks:"; cat "$work/said"; }
else
    absent="a namespace of users"
fi

[ $failed -eq 0 ] || exit 1
[ -z "${absent:-}" ] || { echo "skipped, absent: $absent"; exit 77; }
echo "settings stay, udev looks again, a purge leaves no file"
