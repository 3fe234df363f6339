#pragma once

#include "vectorlib/vectorization/BlockSearchPlain.h"

#if defined(VECTORLIB_SIMD_AVX2)

namespace vectorlib::blocks {

/// Four rows of sums.
struct FourRows {
    __m256d n, x, y, xx, yy, xy;
};

/// Bit i: whether interval i fits.
VECTORLIB_AVX2 VECTORLIB_INLINE unsigned fittingAvx2(const FourRows &s, double variance) {
    const __m256d limit = s.n * _mm256_set1_pd(variance);
    const __m256d a = s.n * (s.xx - limit) - s.x * s.x, b = s.n * (s.yy - limit) - s.y * s.y;
    const __m256d c = s.n * s.xy - s.x * s.y;
    const __m256d exceeds = _mm256_and_pd(_mm256_cmp_pd(b, _mm256_setzero_pd(), _CMP_GT_OQ),
                                          _mm256_cmp_pd(a * b, c * c, _CMP_GT_OQ));
    return static_cast<unsigned>(_mm256_movemask_pd(exceeds)) ^ 15u;
}

VECTORLIB_AVX2 VECTORLIB_INLINE __m256d differenceAvx2(const double *column, double before) {
    return _mm256_sub_pd(_mm256_loadu_pd(column), _mm256_set1_pd(before));
}
/// The twin of fittingRows().
template <std::size_t stride>
VECTORLIB_AVX2 VECTORLIB_INLINE unsigned fittingRowsAvx2(const BlockSums &sums, Index k, const Cut &from,
                                                         double variance) {
    const SumTable &t = sums.table();
    const __m256d last = _mm256_set1_pd(double(sums.size())), at = _mm256_set1_pd(double(from.index));
    __m256d index =
        _mm256_set1_pd(double(k * Index(stride))) + _mm256_setr_pd(0, stride, 2 * stride, 3 * stride);
    unsigned bits = 0;
    for (unsigned i = 0; i < 8; i += 4, k += 4, index = index + _mm256_set1_pd(4 * stride)) {
        const __m256d n = _mm256_min_pd(_mm256_max_pd(index, _mm256_setzero_pd()), last) - at;
        bits |= fittingAvx2({n, differenceAvx2(t.x() + k, from.row.x), differenceAvx2(t.y() + k, from.row.y),
                             differenceAvx2(t.xx() + k, from.row.xx), differenceAvx2(t.yy() + k, from.row.yy),
                             differenceAvx2(t.xy() + k, from.row.xy)},
                            variance)
                << i;
    }
    return bits;
}

/// Running sums of eight values behind sums[0], the sum before them.
VECTORLIB_AVX2 VECTORLIB_INLINE void putRunningAvx2(__m256 v, double before, double *sums) {
    const __m256d low = simd::runningAvx2(_mm256_cvtps_pd(_mm256_castps256_ps128(v)), _mm256_set1_pd(before));
    sums[0] = before;
    _mm256_storeu_pd(sums + 1, low);
    _mm256_storeu_pd(sums + 5, simd::runningAvx2(_mm256_cvtps_pd(_mm256_extractf128_ps(v, 1)),
                                                 _mm256_permute4x64_pd(low, 0xff)));
}

/// The twin of intoBlock(). The block's points are added up in float.
template <bool back>
VECTORLIB_AVX2 VECTORLIB_INLINE Cut intoBlockAvx2(const BlockSums &sums, Index b, const Cut &from,
                                                  double variance) {
    const SumTable &table = sums.table();
    const float *const p = &sums.points(static_cast<std::size_t>(b))->x, *const middle = p + BlockSums::block;
    // The sums from the cut to the block's begin, moved to the block's middle.
    const Index begin = b * Index(BlockSums::block);
    const double ox = middle[0] - sums.origin().x, oy = middle[1] - sums.origin().y;
    const double n = double(begin) - double(from.index);
    const SumRow s = table.row(b) - from.row;
    const double x = s.x - n * ox, y = s.y - n * oy;
    const double xx = s.xx - ox * (s.x + x), yy = s.yy - oy * (s.y + y), xy = s.xy - ox * s.y - oy * x;
    // Lane i gets the points 4 i .. 4 i + 3 of the block, and their sums.
    __m256d corners[2][4];
    for (int half = 0; half < 2; ++half) {
        const double *const q = reinterpret_cast<const double *>(p) + 8 * half;
        const __m256d i = _mm256_loadu_pd(q), j = _mm256_loadu_pd(q + 4), k = _mm256_loadu_pd(q + 16),
                      l = _mm256_loadu_pd(q + 20);
        const __m256d e = _mm256_unpacklo_pd(i, j), f = _mm256_unpackhi_pd(i, j),
                      g = _mm256_unpacklo_pd(k, l), h = _mm256_unpackhi_pd(k, l);
        corners[half][0] = _mm256_permute2f128_pd(e, g, 0x20);
        corners[half][1] = _mm256_permute2f128_pd(f, h, 0x20);
        corners[half][2] = _mm256_permute2f128_pd(e, g, 0x31);
        corners[half][3] = _mm256_permute2f128_pd(f, h, 0x31);
    }
    const __m256 mx = _mm256_broadcast_ss(middle), my = _mm256_broadcast_ss(middle + 1);
    __m256 sx, sy, sxx, syy, sxy;
    for (int k = 0; k < 4; ++k) {
        const __m256 i = _mm256_castpd_ps(corners[0][k]), j = _mm256_castpd_ps(corners[1][k]);
        const __m256 dx = _mm256_shuffle_ps(i, j, 0x88) - mx, dy = _mm256_shuffle_ps(i, j, 0xdd) - my;
        sx = k == 0 ? dx : sx + dx;
        sy = k == 0 ? dy : sy + dy;
        sxx = k == 0 ? dx * dx : sxx + dx * dx;
        syy = k == 0 ? dy * dy : syy + dy * dy;
        sxy = k == 0 ? dx * dy : sxy + dx * dy;
    }
    double X[9], Y[9], XX[9], YY[9], XY[9];
    putRunningAvx2(sx, x, X);
    putRunningAvx2(sy, y, Y);
    putRunningAvx2(sxx, xx, XX);
    putRunningAvx2(syy, yy, YY);
    putRunningAvx2(sxy, xy, XY);
    const __m256d base = _mm256_set1_pd(n);
    const auto four = [&](int i) VECTORLIB_AVX2 {
        return FourRows{base + _mm256_setr_pd(4 * i, 4 * i + 4, 4 * i + 8, 4 * i + 12),
                        _mm256_loadu_pd(X + i),
                        _mm256_loadu_pd(Y + i),
                        _mm256_loadu_pd(XX + i),
                        _mm256_loadu_pd(YY + i),
                        _mm256_loadu_pd(XY + i)};
    };
    const unsigned fours = fittingAvx2(four(1), variance) | fittingAvx2(four(5), variance) << 4;
    const Index count = std::min<Index>(Index(sums.size()) - begin, BlockSums::block);
    const Index sure = sureIn<back>(begin, count, Index(from.index));
    const Index g = chooseFour<back>(fours, count, sure);
    // The four points from there on, one after the other.
    const __m128 i = _mm_loadu_ps(p + 8 * g), j = _mm_loadu_ps(p + 8 * g + 4);
    const __m256d dx = _mm256_cvtps_pd(_mm_shuffle_ps(i, j, 0x88)) - _mm256_set1_pd(middle[0]);
    const __m256d dy = _mm256_cvtps_pd(_mm_shuffle_ps(i, j, 0xdd)) - _mm256_set1_pd(middle[1]);
    const FourRows r{base + _mm256_set1_pd(double(4 * g)) + _mm256_setr_pd(1, 2, 3, 4),
                     simd::runningAvx2(dx, _mm256_broadcast_sd(X + g)),
                     simd::runningAvx2(dy, _mm256_broadcast_sd(Y + g)),
                     simd::runningAvx2(dx * dx, _mm256_broadcast_sd(XX + g)),
                     simd::runningAvx2(dy * dy, _mm256_broadcast_sd(YY + g)),
                     simd::runningAvx2(dx * dy, _mm256_broadcast_sd(XY + g))};
    const Index k = choosePoint<back>(fittingAvx2(r, variance), g, count, sure);
    double column[5][5] = {{X[g]}, {Y[g]}, {XX[g]}, {YY[g]}, {XY[g]}};
    _mm256_storeu_pd(column[0] + 1, r.x);
    _mm256_storeu_pd(column[1] + 1, r.y);
    _mm256_storeu_pd(column[2] + 1, r.xx);
    _mm256_storeu_pd(column[3] + 1, r.yy);
    _mm256_storeu_pd(column[4] + 1, r.xy);
    const double number = n + double(4 * g + k), lx = column[0][k], ly = column[1][k];
    const SumRow row{lx + number * ox, ly + number * oy, column[2][k] + ox * (2 * lx + number * ox),
                     column[3][k] + oy * (2 * ly + number * oy),
                     column[4][k] + ox * (ly + number * oy) + oy * lx};
    return {static_cast<std::size_t>(begin + 4 * g + k), from.row + row};
}

/// The twin of farthest().
template <std::size_t stride, bool back>
VECTORLIB_AVX2 Cut farthestAvx2(const BlockSums &sums, const Cut &from, double variance) {
    const Index at = Index(from.index), size = Index(stride), last = sums.lastRow();
    const Index start = back ? (at + size - 1) / size : at / size;
    Index good = stride > 1 ? start : start + (back ? -2 : 2);
    for (Index k = back ? start - 8 : start + 1; back ? good > 0 && k > -8 : good < last && k <= last;
         k += back ? -8 : 8) {
        const unsigned bits = fittingRowsAvx2<stride>(sums, k, from, variance);
        const Index row = k + farthestBit<back>(bits, good - k);
        good = back ? std::min(good, row) : std::max(good, row);
        if (isEnd<stride, back>(bits))
            break;
    }
    if (back ? good <= 0 : good >= last)
        return back ? Cut{0, SumRow{}} : Cut{sums.size(), sums.table().row(last)};
    if (stride > 1)
        return atLeastTwo<back>(sums, from,
                                intoBlockAvx2<back>(sums, back ? good - 1 : good, from, variance));
    return {static_cast<std::size_t>(good), sums.table().row(good)};
}

} // namespace vectorlib::blocks

#endif
