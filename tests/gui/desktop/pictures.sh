#!/bin/sh
# docs/pictures/make makes every picture that it promises, of the size that it promises.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
HERMES_PICTURE_S=1 "$HERMES_SOURCE/docs/pictures/make" "$folder" >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
for picture in daemons settings commands log plots drive setup cloud settings-dark settings-200; do
    [ -s "$folder/desktop-$picture.png" ] || { echo "desktop-$picture.png is missing"; exit 1; }
done
size() { od -An -tu1 -j16 -N8 "$1" | awk '{ print $3 * 256 + $4 "x" $7 * 256 + $8 }'; }
[ "$(size "$folder/desktop-settings.png")" = 1280x720 ] || { size "$folder/desktop-settings.png"; exit 1; }
[ "$(size "$folder/desktop-settings-200.png")" = 2560x1440 ] || { size "$folder/desktop-settings-200.png"; exit 1; }
