#pragma once

#include "vectorlib/simd/Simd.h"

#if defined(VECTORLIB_SIMD_AVX2)

/// Sums of a few points around a place, in float: for those who look where lines end.
namespace vectorlib::simd {

/// The sums of eight groups of points.
struct EightSums {
    __m256 x, y, xx, yy, xy;
};

/// Values i places further on, for running sums; zeros before them. In both halves.
template <int i>
VECTORLIB_AVX2 VECTORLIB_INLINE __m256 shiftedAvx2(__m256 v) {
    return _mm256_castsi256_ps(_mm256_slli_si256(_mm256_castps_si256(v), 4 * i));
}
template <int i>
VECTORLIB_AVX2 VECTORLIB_INLINE __m128 shiftedAvx2(__m128 v) {
    return _mm_castsi128_ps(_mm_slli_si128(_mm_castps_si128(v), 4 * i));
}
/// Running sums of four values, or of four in each half.
template <typename Register>
VECTORLIB_AVX2 VECTORLIB_INLINE Register runningFourAvx2(Register v) {
    v = v + shiftedAvx2<1>(v);
    return v + shiftedAvx2<2>(v);
}

/// Of eight points, each alone, relative to (mx, my). The points are given as x, y, x, y, ...
VECTORLIB_AVX2 VECTORLIB_INLINE EightSums sumOnesAvx2(const float *points, __m256 mx, __m256 my) {
    const __m256 a = _mm256_loadu_ps(points), b = _mm256_loadu_ps(points + 8);
    // Points 0, 1, 4, 5 and 2, 3, 6, 7: from halves in the right order.
    const __m256 c = _mm256_permute2f128_ps(a, b, 0x20), d = _mm256_permute2f128_ps(a, b, 0x31);
    const __m256 x = _mm256_shuffle_ps(c, d, 0x88) - mx, y = _mm256_shuffle_ps(c, d, 0xdd) - my;
    return {x, y, x * x, y * y, x * y};
}

/// Of eight times four points, relative to (mx, my).
VECTORLIB_AVX2 VECTORLIB_INLINE EightSums sumFoursAvx2(const float *points, __m256 mx, __m256 my) {
    // Two points of a four, and two of the four that is four later.
    const auto pairs = [points](int i) VECTORLIB_AVX2 {
        const __m256 low = _mm256_castps128_ps256(_mm_loadu_ps(points + 4 * i));
        return _mm256_castps_pd(_mm256_insertf128_ps(low, _mm_loadu_ps(points + 4 * i + 32), 1));
    };
    EightSums s;
    const auto add = [&](bool isFirst, __m256d i, __m256d j) VECTORLIB_AVX2 {
        const __m256 c = _mm256_castpd_ps(i), d = _mm256_castpd_ps(j);
        const __m256 x = _mm256_shuffle_ps(c, d, 0x88) - mx, y = _mm256_shuffle_ps(c, d, 0xdd) - my;
        s.x = isFirst ? x : s.x + x;
        s.y = isFirst ? y : s.y + y;
        s.xx = isFirst ? x * x : _mm256_fmadd_ps(x, x, s.xx);
        s.yy = isFirst ? y * y : _mm256_fmadd_ps(y, y, s.yy);
        s.xy = isFirst ? x * y : _mm256_fmadd_ps(x, y, s.xy);
    };
    for (int k = 0; k < 2; ++k) {
        const __m256d e = pairs(k), f = pairs(k + 2), g = pairs(k + 4), h = pairs(k + 6);
        add(k == 0, _mm256_unpacklo_pd(e, f), _mm256_unpacklo_pd(g, h));
        add(false, _mm256_unpackhi_pd(e, f), _mm256_unpackhi_pd(g, h));
    }
    return s;
}

} // namespace vectorlib::simd

#endif
