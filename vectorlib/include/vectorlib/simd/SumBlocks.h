#pragma once

#include "vectorlib/simd/Simd.h"

/// The sums of blocks of points: offsets from the middle of each block are added up in float. Four blocks at
/// a time, because the sums of four blocks make one register.
namespace vectorlib::simd {

constexpr std::size_t blockPoints = 32;

/// The local sums of four blocks.
struct FourSums {
    double x[4], y[4], xx[4], yy[4], xy[4];
};

/// The sums of the points of four blocks relative to the middle of their block (point 16). The points are
/// given as x, y, x, y, ...
inline FourSums sumFourBlocks(const float *points) {
    FourSums sums;
    for (int b = 0; b < 4; ++b, points += 2 * blockPoints) {
        // Eight lanes, as AVX2 has them.
        float s[8] = {}, squares[8] = {}, products[8] = {};
        for (std::size_t i = 0; i < 2 * blockPoints; i += 16) {
            float c[8], d[8];
            for (std::size_t l = 0; l < 8; ++l) {
                c[l] = points[i + l] - points[blockPoints + l % 2];
                d[l] = points[i + 8 + l] - points[blockPoints + l % 2];
                s[l] = (s[l] + c[l]) + d[l];
                squares[l] = (squares[l] + c[l] * c[l]) + d[l] * d[l];
            }
            for (std::size_t l = 0; l < 2; ++l) {
                products[l] += c[2 * l] * c[2 * l + 1];
                products[l + 2] += d[2 * l] * d[2 * l + 1];
                products[l + 4] += c[2 * l + 4] * c[2 * l + 5];
                products[l + 6] += d[2 * l + 4] * d[2 * l + 5];
            }
        }
        const auto total = [](const float *v) { return double((v[0] + v[2]) + (v[4] + v[6])); };
        sums.x[b] = total(s);
        sums.y[b] = total(s + 1);
        sums.xx[b] = total(squares);
        sums.yy[b] = total(squares + 1);
        sums.xy[b] = total(products) + total(products + 1);
    }
    return sums;
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

VECTORLIB_AVX2 VECTORLIB_INLINE __m256 addPairsAvx2(__m256 a, __m256 b) {
    const __m256d c = _mm256_castps_pd(a), d = _mm256_castps_pd(b);
    return _mm256_add_ps(_mm256_castpd_ps(_mm256_unpacklo_pd(c, d)),
                         _mm256_castpd_ps(_mm256_unpackhi_pd(c, d)));
}

/// The sums of x and y, of their squares and of their products (of even and of odd points) in a block: two
/// pairs of lanes to be added up.
struct LaneSums {
    __m256 sums, squares, products;
};
VECTORLIB_AVX2 VECTORLIB_INLINE LaneSums sumBlockAvx2(const float *points) {
    const __m256 middle =
        _mm256_castpd_ps(_mm256_broadcast_sd(reinterpret_cast<const double *>(points + blockPoints)));
    LaneSums s;
    for (int i = 0; i < 4; ++i) {
        const __m256 c = _mm256_loadu_ps(points + 16 * i) - middle;
        const __m256 d = _mm256_loadu_ps(points + 16 * i + 8) - middle;
        const __m256 product = _mm256_shuffle_ps(c, d, 0x88) * _mm256_shuffle_ps(c, d, 0xdd);
        s.sums = (i == 0 ? c : s.sums + c) + d;
        s.squares = (i == 0 ? c * c : s.squares + c * c) + d * d;
        s.products = i == 0 ? product : s.products + product;
    }
    return s;
}
VECTORLIB_AVX2 VECTORLIB_INLINE LaneSums addPairsAvx2(const LaneSums &a, const LaneSums &b) {
    return {addPairsAvx2(a.sums, b.sums), addPairsAvx2(a.squares, b.squares),
            addPairsAvx2(a.products, b.products)};
}
/// Pairs of x and y, two a block, of blocks 0 and 1 and of blocks 2 and 3, to the four sums of x and the four
/// of y.
VECTORLIB_AVX2 VECTORLIB_INLINE void addHalvesAvx2(__m256 a, __m256 b, __m256d &x, __m256d &y) {
    const __m256 s = _mm256_permute2f128_ps(a, b, 0x20) + _mm256_permute2f128_ps(a, b, 0x31);
    const __m128 low = _mm256_castps256_ps128(s), high = _mm256_extractf128_ps(s, 1);
    x = _mm256_cvtps_pd(_mm_shuffle_ps(low, high, 0x88));
    y = _mm256_cvtps_pd(_mm_shuffle_ps(low, high, 0xdd));
}

/// The twin of sumFourBlocks().
VECTORLIB_AVX2 VECTORLIB_INLINE void sumFourBlocksAvx2(const float *points, __m256d &x, __m256d &y,
                                                       __m256d &xx, __m256d &yy, __m256d &xy) {
    constexpr std::size_t next = 2 * blockPoints;
    const LaneSums a = addPairsAvx2(sumBlockAvx2(points), sumBlockAvx2(points + next));
    const LaneSums b = addPairsAvx2(sumBlockAvx2(points + 2 * next), sumBlockAvx2(points + 3 * next));
    __m256d even, odd;
    addHalvesAvx2(a.sums, b.sums, x, y);
    addHalvesAvx2(a.squares, b.squares, xx, yy);
    addHalvesAvx2(a.products, b.products, even, odd);
    xy = even + odd;
}
#endif

} // namespace vectorlib::simd
