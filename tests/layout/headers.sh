#!/usr/bin/env bash
# Builds a program of all headers of an installed vectorlib without the library (vectorlib::headers). Any two sources may include
# them, so all functions must be inline.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$HERMES_BUILD" --prefix "$work/prefix" --component vectorlib >/dev/null
mkdir "$work/program"
cat >"$work/program/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(headers CXX)
find_package(vectorlib 0.1 REQUIRED)
add_executable(headers main.cpp)
target_link_libraries(headers PRIVATE vectorlib::headers)
END
(cd "$work/prefix/include" && find vectorlib -name '*.h' -printf '#include <%p>\n' | sort) >"$work/program/main.cpp"
echo 'int main() { return static_cast<int>(vectorlib::MapBuilder().map.size()); }' >>"$work/program/main.cpp"
cmake -S "$work/program" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
cmake --build "$work/build" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$work/build/headers"
outside=$(nm -C --defined-only "$work/build/CMakeFiles/headers.dir/main.cpp.o" | grep -E '^[0-9a-f]+ [TDB] ' | grep -v ' main$') || true
[ -z "$outside" ] || { echo "expected inline in the sources of vectorlib: $outside"; exit 1; }
