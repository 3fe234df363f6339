#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace vectorlib::simd {

/// The nearest of eight points to (px, py), by number, and its squared distance, right to a millionth. The
/// number replaces the last three bits of each squared distance: one minimum then finds both, and of equal
/// ones the first. Positive floats keep their order when their bits are read as integers.
struct NearestOfEight {
    int number;
    float squared;

    NearestOfEight(const float *x, const float *y, float px, float py) {
        std::int32_t least;
#if defined(__GNUC__)
        typedef float Floats __attribute__((vector_size(16)));
        typedef std::int32_t Ints __attribute__((vector_size(16)));
        const auto marked = [&](int from, Ints numbers) {
            Floats dx, dy;
            std::memcpy(&dx, x + from, sizeof dx);
            std::memcpy(&dy, y + from, sizeof dy);
            dx -= px;
            dy -= py;
            return (reinterpret_cast<Ints>(dx * dx + dy * dy) & ~7) | numbers;
        };
        const Ints a = marked(0, Ints{0, 1, 2, 3}), b = marked(4, Ints{4, 5, 6, 7}), m = a < b ? a : b;
        least = std::min(std::min(m[0], m[1]), std::min(m[2], m[3]));
#else
        for (int k = 0; k < 8; ++k) {
            const float dx = x[k] - px, dy = y[k] - py, d = dx * dx + dy * dy;
            std::int32_t bits;
            std::memcpy(&bits, &d, sizeof bits);
            bits = (bits & ~7) | k;
            least = k == 0 ? bits : std::min(least, bits);
        }
#endif
        number = least & 7;
        std::memcpy(&squared, &least, sizeof squared);
    }
};

} // namespace vectorlib::simd
