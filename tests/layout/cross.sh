#!/usr/bin/env bash
# deploy/build-cross and deploy/root-run: who may not use them is told why; a root folder has no mounts left afterwards.
set -euo pipefail
cd "$HERMES_SOURCE"
# refused TEXT COMMAND...: exit status 2, and that text
refused() {
    local said status=0
    said=$("${@:2}" 2>&1) || status=$?
    [ $status -eq 2 ] && grep -qF -- "$1" <<<"$said" || { echo "${*:2}: status $status, expected 2 and '$1': $said"; exit 1; }
}
refused "unknown argument 'mips'" deploy/build-cross mips
refused "Usage:" deploy/build-cross
refused "--test needs the tests" deploy/build-cross --no-tests --test armhf
refused "stand alone" deploy/build-cross --packages --test armhf
refused "stand alone" deploy/build-cross --packages --demo armhf
refused "has no /bin/sh" deploy/root-run /nonexistent true
refused "expected a root folder and a command" deploy/root-run /
[ "$(id -u)" -eq 0 ] || { echo "skipped: what needs root"; exit 77; }
nobody=(setpriv --reuid 65534 --regid 65534 --clear-groups)
refused "expected root" "${nobody[@]}" bash deploy/build-cross armhf
refused "expected root" "${nobody[@]}" bash deploy/root-run / true

root=$(mktemp -d) # of a shell and what it needs
trap 'rm -rf --one-file-system "$root"' EXIT
mkdir -p "$root/etc"
for file in /bin/sh $(ldd /bin/sh | grep -o '/[^ ]*'); do
    mkdir -p "$root$(dirname "$file")"
    cp -L "$file" "$root$file"
done
unshare --mount true 2>/dev/null || { echo "skipped: no mount namespaces here"; exit 77; }
inside=$(deploy/root-run "$root" /bin/sh -c 'echo here >/dev/null && test -e /proc/self/exe && test ! -e /usr/bin/env && pwd')
[ "$inside" = "$HERMES_SOURCE" ] || { echo "it ran in '$inside', expected the folder it was called in"; exit 1; }
status=0
deploy/root-run "$root" /bin/sh -c 'exit 3' || status=$?
[ $status -eq 3 ] || { echo "exit status $status, expected 3 of the command"; exit 1; }
deploy/root-run "$root" /bin/sh -c 'kill -9 $$' 2>/dev/null || true
! grep -F "$root" /proc/self/mounts || { echo "mounts are left"; exit 1; }
