#!/usr/bin/env bash
# Installs vectorlib into a temporary prefix and builds a ten-line program against it with find_package(vectorlib).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$HERMES_BUILD" --prefix "$work/prefix" --component vectorlib >/dev/null
mkdir "$work/program"
cat >"$work/program/CMakeLists.txt" <<'EOF'
cmake_minimum_required(VERSION 3.25)
project(tenlines CXX)
find_package(vectorlib 0.1 REQUIRED)
add_executable(tenlines main.cpp)
target_link_libraries(tenlines PRIVATE vectorlib::vectorlib)
EOF
cat >"$work/program/main.cpp" <<'EOF'
#include <cstdio>
#include <vectorlib/vectorlib.h>
int main() {
    std::vector<vectorlib::Vector2D<float>> corner;
    for (int i = 0; i <= 100; ++i)
        corner.push_back(i < 50 ? vectorlib::Vector2D<float>(2, -2 + 0.08f * i) : vectorlib::Vector2D<float>(6 - 0.08f * i, 2));
    vectorlib::FtlsVectorizer<float> vectorize;
    for (const auto &line : vectorize(corner))
        std::printf("%.2f %.2f  %.2f %.2f\n", line.segment.begin().x, line.segment.begin().y, line.segment.end().x, line.segment.end().y);
}
EOF
cmake -S "$work/program" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
cmake --build "$work/build" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$work/build/tenlines" | tee "$work/out"
[ "$(wc -l <"$work/out")" -eq 2 ] || { echo "expected the two lines of a corner"; exit 1; }
