#!/usr/bin/env bash
# Builds segmentation_levels.cpp for ARMv7 with NEON and runs it in the emulator (g++-arm-linux-gnueabihf,
# qemu-user-static of Debian).
set -euo pipefail
for tool in arm-linux-gnueabihf-g++ qemu-arm-static pkg-config; do
    command -v "$tool" >/dev/null || { echo "skipped: $tool is not installed"; exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
read -r -a eigen <<<"$(pkg-config --cflags-only-I eigen3 | sed 's/-I/-isystem /g')"
arm-linux-gnueabihf-g++ -std=c++17 -O2 -Wall -Wextra -Wpedantic -Wshadow -Werror -ffp-contract=off -march=armv7-a \
    -mfpu=neon -mfloat-abi=hard -static "${eigen[@]}" -I"$HERMES_SOURCE/vectorlib/include" \
    "$HERMES_SOURCE/tests/vectorlib/segmentation_levels.cpp" -o "$work/levels"
qemu-arm-static "$work/levels" | tee "$work/out"
grep -q "best level: NEON" "$work/out" || { echo "NEON was not used"; exit 1; }
