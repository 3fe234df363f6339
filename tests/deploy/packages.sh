#!/usr/bin/env bash
# The Debian packages: built twice they are the same bit for bit, and lintian finds nothing that is not explained.
set -euo pipefail
. "$HERMES_SOURCE/deploy/bootstrap.sh"
command -v lintian >/dev/null || { echo "skipped: needs lintian"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$HERMES_SOURCE/deploy/package" --out "$HERMES_SOURCE/build/packages"
CCACHE_DISABLE=1 "$HERMES_SOURCE/deploy/package" --out "$work"
for package in "$work"/*.deb; do
    cmp "$package" "$HERMES_SOURCE/build/packages/$(basename "$package")"
done
echo "$(find "$work" -name '*.deb' | wc -l) packages are the same when built again"
lintian --fail-on error,warning "$work"/*.deb
