#!/usr/bin/env bash
# `cmake --install --prefix` anywhere: what is installed names its programs and data below that prefix, and they are there. The list of
# files that it leaves removes all of them. With DESTDIR, as for packages, the names are those of the prefix.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
fail() {
    echo "FAILED: $1"
    failed=1
}

below() { # FOLDER PREFIX: each path of Hermes that an installed text names is below PREFIX and is in FOLDER
    local path count=0
    while read -r path; do
        count=$((count + 1))
        case $path in "$2"/*) [ -e "$1${path#"$2"}" ] || fail "$path is named and is not there" ;; *) fail "$path is not below $2" ;; esac
    done < <(grep -rhIoE '/[A-Za-z0-9._/-]*/(bin/hermes[a-z-]*|share/hermes/[A-Za-z0-9._/-]*)' "$1/lib" "$1/share" | sort -u)
    [ $count -ge 4 ] || fail "expected the paths of a unit, a menu entry, a world and a script of the board, found $count"
}

cmake --install "$HERMES_BUILD" --prefix "$work/one" >/dev/null
below "$work/one" "$work/one"
grep -q "^ExecStart=$work/one/bin/hermes-supervisor " "$work/one/lib/systemd/system/hermes-supervisor.service" || fail "ExecStart of the service"
grep -q "^Exec=$work/one/bin/hermes-gui$" "$work/one/share/applications/hermes-gui.desktop" || fail "Exec of the menu entry"
"$work/one/bin/hermes-supervisor" --print-settings | grep -q "\"samples\": \"$work/one/share/hermes/settings\"" || fail "setup.samples"

xargs -d '\n' rm -- <"$HERMES_BUILD/install_manifest.txt"
left=$(find "$work/one" ! -type d)
[ -z "$left" ] || fail "left after the removal: $left"

DESTDIR=$work/two cmake --install "$HERMES_BUILD" --prefix /usr >/dev/null
below "$work/two/usr" /usr
[ $failed -eq 0 ] && echo "all paths fit the prefix"
exit $failed
