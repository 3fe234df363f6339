#!/usr/bin/env bash
# What the package's postinst does to the files of a system, which is a temporary folder: settings that are there stay.
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
chmod +x "$work"/bin/*

fresh() { # a system before the package is configured
    rm -rf "$work/root"
    mkdir -p "$work/root/etc" "$work/root/var/lib" "$work/root/run" "$work/root/usr/share/hermes"
    cp -r "$HERMES_SOURCE/deploy/settings" "$work/root/usr/share/hermes/settings"
    etc=$work/root/etc/hermes
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

[ $failed -eq 0 ] && echo "the package leaves alone what is not its own"
exit $failed
