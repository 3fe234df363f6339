#!/usr/bin/env bash
# Builds simd_levels.cpp for ARM and runs it in the emulator: ARMv7 with NEON and without it, from one program, and
# AArch64 (of Debian: g++-arm-linux-gnueabihf, g++-aarch64-linux-gnu, qemu-user-static). And without any SIMD here.
set -euo pipefail
unset QEMU_CPU # each emulator below is told its own
command -v pkg-config >/dev/null || { echo "skipped: pkg-config is not installed"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
read -r -a eigen <<<"$(pkg-config --cflags-only-I eigen3 | sed 's/-I/-isystem /g')"

# build COMPILER [OPTION...]
build() {
    "$@" -std=c++17 -O2 -Wall -Wextra -Wpedantic -Wshadow -Werror -Wno-psabi -ffp-contract=off -static "${eigen[@]}" \
        -I"$HERMES_SOURCE/vectorlib/include" "$HERMES_SOURCE/tests/vectorlib/simd_levels.cpp" -o "$work/levels"
}
# expect LEVEL COMMAND...
expect() {
    "${@:2}" | tee "$work/out"
    grep -q "best level: $1" "$work/out" || { echo "$1 was not used"; exit 1; }
}
# installed TOOL...: otherwise says which is not, and leaves the test to be skipped.
missing=0
installed() {
    for tool in "$@"; do
        command -v "$tool" >/dev/null || { echo "skipped: $tool is not installed"; missing=77; return 1; }
    done
}

build c++ -DVECTORLIB_PLAIN
expect "plain C++" "$work/levels"
if installed arm-linux-gnueabihf-g++ qemu-arm-static; then
    build arm-linux-gnueabihf-g++
    expect NEON qemu-arm-static -cpu cortex-a7 "$work/levels"
    bare=cortex-a7,neon=off
    qemu-arm-static -cpu $bare "$work/levels" >/dev/null 2>&1 || bare+=,vfp-d32=off # as QEMU 8 and later want it
    expect "plain C++" qemu-arm-static -cpu $bare "$work/levels"
fi
if installed aarch64-linux-gnu-g++ qemu-aarch64-static; then
    build aarch64-linux-gnu-g++
    expect NEON qemu-aarch64-static "$work/levels"
fi
exit $missing
