#!/usr/bin/env bash
# Fails when a C++ file is not as .clang-format says; skips where clang-format is absent.
cd "$HERMES_SOURCE" || exit 1
command -v clang-format >/dev/null || { echo "skipped: clang-format is not installed"; exit 77; }
mapfile -t files < <(find vectorlib protocol common daemons gui tests docs/examples -name '*.h' -o -name '*.cpp')
[ ${#files[@]} -gt 0 ] || { echo "found no source files below $HERMES_SOURCE"; exit 1; }
clang-format --dry-run --Werror "${files[@]}" && echo "${#files[@]} files are formatted"
