#pragma once

#include "vectorlib/simd/Simd.h"

namespace vectorlib::simd {

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
