#pragma once

#include "vectorlib/simd/Simd.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace vectorlib::simd {

/// The largest of sixteen numbers.
inline std::int16_t largestOfSixteen(const std::int16_t *numbers) {
#if defined(__clang__) || __GNUC__ >= 12
    typedef std::int16_t Shorts __attribute__((vector_size(16)));
    Shorts a, b;
    std::memcpy(&a, numbers, sizeof a);
    std::memcpy(&b, numbers + 8, sizeof b);
    a = a > b ? a : b;
    b = __builtin_shufflevector(a, a, 4, 5, 6, 7, 0, 1, 2, 3);
    a = a > b ? a : b;
    b = __builtin_shufflevector(a, a, 2, 3, 0, 1, 6, 7, 4, 5);
    a = a > b ? a : b;
    return std::max(a[0], a[1]);
#else
    return *std::max_element(numbers, numbers + 16);
#endif
}

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

/// The number of the highest bit that is set; bits is not 0.
inline unsigned highestBit(unsigned bits) {
#if defined(__GNUC__)
    return 31 - static_cast<unsigned>(__builtin_clz(bits));
#else
    unsigned bit = 0;
    while (bits >>= 1)
        ++bit;
    return bit;
#endif
}
/// The number of the lowest bit that is set; bits is not 0.
inline unsigned lowestBit(unsigned bits) {
#if defined(__GNUC__)
    return static_cast<unsigned>(__builtin_ctz(bits));
#else
    return highestBit(bits & (0 - bits));
#endif
}

#if defined(VECTORLIB_SIMD_AVX2)
/// The same for count >= 8.
VECTORLIB_AVX2 inline void rampEights(int *out, std::size_t count, int first, int step) {
    const __m256i steps =
        _mm256_mullo_epi32(_mm256_set1_epi32(step), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
    const auto store = [&](std::size_t i) VECTORLIB_AVX2 {
        const __m256i v = _mm256_add_epi32(_mm256_set1_epi32(first + step * static_cast<int>(i)), steps);
        _mm256_storeu_si256(reinterpret_cast<__m256i *>(out + i), v);
    };
    for (std::size_t i = 0; i + 8 <= count; i += 8)
        store(i);
    store(count - 8); // the rest, and some once more
}
#endif

/// Writes first, first + step, ...
inline void ramp(int *out, std::size_t count, int first, int step, Level level) {
#if defined(VECTORLIB_SIMD_AVX2)
    if (level != Level::Scalar && count >= 8)
        return rampEights(out, count, first, step);
#endif
    static_cast<void>(level);
    for (std::size_t i = 0; i < count; ++i)
        out[i] = first + step * static_cast<int>(i);
}

} // namespace vectorlib::simd
