#pragma once

#include "vectorlib/simd/Simd.h"

#include <initializer_list>

/// The sums of blocks of points, in float: of offsets from the middle of each block.
namespace vectorlib::simd {

/// How many points a block has.
constexpr std::size_t blockPoints = 32;

/// The sums of a block's points relative to its middle (point 16). Those of the products are left in four
/// parts: who adds up four blocks does that at once.
struct BlockSum {
    float x, y, xx, yy;
    float xy[4];
};

/// The sums of the points of a block; these are given as x, y, x, y, ...
inline BlockSum sumBlock(const float *points) {
    // Eight lanes, as AVX2 has them, of eight points each.
    float s[4][8], squares[4][8], products[4][8];
    for (std::size_t i = 0; i < 4; ++i) {
        float c[8], d[8];
        for (std::size_t l = 0; l < 8; ++l) {
            c[l] = points[16 * i + l] - points[blockPoints + l % 2];
            d[l] = points[16 * i + 8 + l] - points[blockPoints + l % 2];
            s[i][l] = c[l] + d[l];
            squares[i][l] = c[l] * c[l] + d[l] * d[l];
        }
        for (std::size_t l = 0; l < 2; ++l) {
            products[i][l] = c[2 * l] * c[2 * l + 1];
            products[i][l + 2] = d[2 * l] * d[2 * l + 1];
            products[i][l + 4] = c[2 * l + 4] * c[2 * l + 5];
            products[i][l + 6] = d[2 * l + 4] * d[2 * l + 5];
        }
    }
    for (std::size_t l = 0; l < 8; ++l)
        for (auto *v : {s, squares, products})
            v[0][l] = (v[0][l] + v[1][l]) + (v[2][l] + v[3][l]);
    const auto total = [](const float *v) { return (v[0] + v[2]) + (v[4] + v[6]); };
    BlockSum sum{total(s[0]), total(s[0] + 1), total(squares[0]), total(squares[0] + 1), {}};
    for (std::size_t l = 0; l < 4; ++l)
        sum.xy[l] = products[0][l] + products[0][l + 4];
    return sum;
}

/// The sums of each four points of a block.
struct SumsOfFours {
    float x[8], y[8], xx[8], yy[8], xy[8];
};

/// The same of a block, relative to its middle.
inline SumsOfFours sumFours(const float *points) {
    SumsOfFours sums;
    for (int i = 0; i < 8; ++i) {
        float x[4], y[4];
        for (int k = 0; k < 4; ++k) {
            x[k] = points[8 * i + 2 * k] - points[blockPoints];
            y[k] = points[8 * i + 2 * k + 1] - points[blockPoints + 1];
        }
        const auto sum = [](const float *a, const float *b) {
            return (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]);
        };
        sums.x[i] = (x[0] + x[1]) + (x[2] + x[3]);
        sums.y[i] = (y[0] + y[1]) + (y[2] + y[3]);
        sums.xx[i] = sum(x, x);
        sums.yy[i] = sum(y, y);
        sums.xy[i] = sum(x, y);
    }
    return sums;
}

#if defined(VECTORLIB_SIMD_AVX2)
/// Running sums of four values, the sum before them included.
VECTORLIB_AVX2 VECTORLIB_INLINE __m256d runningAvx2(__m256d v, __m256d before) {
    v = _mm256_add_pd(v, _mm256_blend_pd(_mm256_permute4x64_pd(v, 0x90), _mm256_setzero_pd(), 1));
    return _mm256_add_pd(_mm256_add_pd(v, _mm256_permute2f128_pd(v, v, 0x08)), before);
}

VECTORLIB_AVX2 VECTORLIB_INLINE __m128 addHalvesAvx2(__m256 v) {
    return _mm_add_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
}
VECTORLIB_AVX2 VECTORLIB_INLINE __m256 totalAvx2(const __m256 *v) {
    return (v[0] + v[1]) + (v[2] + v[3]);
}
/// The twin of sumBlock(). The differences come from the units for products, which have less to do than those
/// for sums: the same bits.
VECTORLIB_AVX2 VECTORLIB_INLINE void sumBlockAvx2(const float *points, BlockSum &sum) {
    const __m256 one = _mm256_set1_ps(1);
    const __m256 middle =
        _mm256_castpd_ps(_mm256_broadcast_sd(reinterpret_cast<const double *>(points + blockPoints)));
    __m256 s[4], squares[4], products[4];
    for (int i = 0; i < 4; ++i) {
        const __m256 c = _mm256_fmsub_ps(_mm256_loadu_ps(points + 16 * i), one, middle);
        const __m256 d = _mm256_fmsub_ps(_mm256_loadu_ps(points + 16 * i + 8), one, middle);
        s[i] = c + d;
        squares[i] = c * c + d * d;
        products[i] = _mm256_shuffle_ps(c, d, 0x88) * _mm256_shuffle_ps(c, d, 0xdd);
    }
    const __m256d a = _mm256_castps_pd(totalAvx2(s)), b = _mm256_castps_pd(totalAvx2(squares));
    _mm_storeu_ps(&sum.x, addHalvesAvx2(_mm256_castpd_ps(_mm256_unpacklo_pd(a, b)) +
                                        _mm256_castpd_ps(_mm256_unpackhi_pd(a, b))));
    _mm_storeu_ps(sum.xy, addHalvesAvx2(totalAvx2(products)));
}

/// Two points.
VECTORLIB_AVX2 VECTORLIB_INLINE __m128 loadTwoAvx2(const float *a, const float *b) {
    return _mm_castpd_ps(
        _mm_loadh_pd(_mm_load_sd(reinterpret_cast<const double *>(a)), reinterpret_cast<const double *>(b)));
}
/// The sums of four blocks as doubles.
struct FourBlockSums {
    __m256d x, y, xx, yy, xy;
};
VECTORLIB_AVX2 VECTORLIB_INLINE FourBlockSums loadFourAvx2(const BlockSum *b) {
    __m128 x = _mm_loadu_ps(&b[0].x), y = _mm_loadu_ps(&b[1].x), xx = _mm_loadu_ps(&b[2].x),
           yy = _mm_loadu_ps(&b[3].x);
    _MM_TRANSPOSE4_PS(x, y, xx, yy);
    const auto addPairs = [](__m128 i, __m128 j) VECTORLIB_AVX2 {
        return _mm_add_ps(_mm_shuffle_ps(i, j, 0x88), _mm_shuffle_ps(i, j, 0xdd));
    };
    const __m128 xy = addPairs(addPairs(_mm_loadu_ps(b[0].xy), _mm_loadu_ps(b[1].xy)),
                               addPairs(_mm_loadu_ps(b[2].xy), _mm_loadu_ps(b[3].xy)));
    return {_mm256_cvtps_pd(x), _mm256_cvtps_pd(y), _mm256_cvtps_pd(xx), _mm256_cvtps_pd(yy),
            _mm256_cvtps_pd(xy)};
}
#endif

} // namespace vectorlib::simd
