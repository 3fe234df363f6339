#!/usr/bin/env bash
# What the package's postinst does to the files of a system, which is a temporary folder: settings that are there stay, and udev looks
# again at what is plugged in.
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

[ $failed -eq 0 ] && echo "settings stay, and udev looks again"
exit $failed
