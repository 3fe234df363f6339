#!/usr/bin/env bash
# Fails when a C++ file is not as .clang-format says. Versions of clang-format differ: that of Debian 12 decides. Skips where it is absent.
cd "$HERMES_SOURCE" || exit 1
[[ $(clang-format --version 2>/dev/null) == *" version 14."* ]] || { echo "skipped: needs clang-format 14"; exit 77; }
mapfile -t files < <(find vectorlib protocol common daemons gui tests docs/examples -name '*.h' -o -name '*.cpp')
[ ${#files[@]} -gt 0 ] || { echo "found no source files below $HERMES_SOURCE"; exit 1; }
clang-format --dry-run --Werror "${files[@]}" && echo "${#files[@]} files are formatted"
