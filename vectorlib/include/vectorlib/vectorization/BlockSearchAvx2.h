#pragma once

#include "vectorlib/simd/SumEights.h"
#include "vectorlib/vectorization/BlockSearchPlain.h"

#if defined(VECTORLIB_SIMD_AVX2)

namespace vectorlib::blocks {

/// a b - c, rounded once where sums of blocks in float are tested, which carry larger errors; else twice, as
/// fits() does: the same intervals fit then.
template <bool once>
VECTORLIB_AVX2 VECTORLIB_INLINE __m256d minusAvx2(__m256d a, __m256d b, __m256d c) {
    return once ? _mm256_fmsub_pd(a, b, c) : a * b - c;
}
/// Bit i: whether interval i fits.
template <bool once>
VECTORLIB_AVX2 VECTORLIB_INLINE unsigned fittingAvx2(const FourRows &s, double variance) {
    const __m256d v = _mm256_set1_pd(variance), limit = s.n * v;
    const __m256d xx = once ? _mm256_fnmadd_pd(s.n, v, s.xx) : s.xx - limit;
    const __m256d yy = once ? _mm256_fnmadd_pd(s.n, v, s.yy) : s.yy - limit;
    const __m256d a = minusAvx2<once>(s.n, xx, s.x * s.x), b = minusAvx2<once>(s.n, yy, s.y * s.y);
    const __m256d c = minusAvx2<once>(s.n, s.xy, s.x * s.y);
    const __m256d exceeds = _mm256_and_pd(_mm256_cmp_pd(b, _mm256_setzero_pd(), _CMP_GT_OQ),
                                          _mm256_cmp_pd(a * b, c * c, _CMP_GT_OQ));
    return static_cast<unsigned>(_mm256_movemask_pd(exceeds)) ^ 15u;
}

VECTORLIB_AVX2 VECTORLIB_INLINE __m256d sumsTo(double before, const double *column) {
    return _mm256_set1_pd(before) - _mm256_loadu_pd(column);
}
/// The twin of fittingRows(); all signs are changed.
template <std::size_t stride, bool back>
VECTORLIB_AVX2 VECTORLIB_INLINE unsigned fittingRowsAvx2(const BlockSums &sums, Index k, const Cut &from,
                                                         double variance) {
    const SumTable &t = sums.table();
    const __m256d at = _mm256_set1_pd(double(Index(from.index))),
                  last = _mm256_set1_pd(double(Index(sums.size())));
    __m256d index =
        _mm256_set1_pd(double(k * Index(stride))) + _mm256_setr_pd(0, stride, 2 * stride, 3 * stride);
    unsigned bits = 0;
    for (unsigned i = 0; i < 8; i += 4, k += 4, index = index + _mm256_set1_pd(4 * stride)) {
        const __m256d n =
            at - (back ? _mm256_max_pd(index, _mm256_setzero_pd()) : _mm256_min_pd(index, last));
        bits |= fittingAvx2<(stride > 1)>({n, sumsTo(from.row.x, t.x() + k), sumsTo(from.row.y, t.y() + k),
                                           sumsTo(from.row.xx, t.xx() + k), sumsTo(from.row.yy, t.yy() + k),
                                           sumsTo(from.row.xy, t.xy() + k)},
                                          variance)
                << i;
    }
    return bits;
}

/// The block in which an interval ends. In three steps, so that two searches can go through theirs side by
/// side.
template <bool back>
class EndBlockAvx2 {
public:
    /// Adds up the block's points by four, in float, and makes the running sums of the interval.
    VECTORLIB_AVX2 VECTORLIB_INLINE EndBlockAvx2(const BlockSums &sums, Index b, const Cut &from)
        : from_(from)
        , points_(&sums.points(static_cast<std::size_t>(b))->x)
        , begin_(b * Index(BlockSums::block))
        , count_(std::min<Index>(Index(sums.size()) - begin_, BlockSums::block))
        , sure_(sureIn<back>(begin_, count_, Index(from.index))) {
        // The sums from the cut to the block's begin, moved to the block's middle.
        const float *const middle = points_ + BlockSums::block;
        n_ = double(begin_) - double(Index(from.index));
        ox_ = middle[0] - sums.origin().x;
        oy_ = middle[1] - sums.origin().y;
        const SumRow before = inFrameAvx2(sums.table().row(b) - from.row, n_, ox_, oy_);
        const simd::EightSums s =
            simd::sumFoursAvx2(points_, _mm256_broadcast_ss(middle), _mm256_broadcast_ss(middle + 1));
        putRunning(s.x, before.x, x_);
        putRunning(s.y, before.y, y_);
        putRunning(s.xx, before.xx, xx_);
        putRunning(s.yy, before.yy, yy_);
        putRunning(s.xy, before.xy, xy_);
    }
    /// Finds the four points in which the interval ends.
    VECTORLIB_AVX2 VECTORLIB_INLINE void findFour(double variance) {
        four_ = chooseFour<back>(
            fittingAvx2<true>(four(1), variance) | fittingAvx2<true>(four(5), variance) << 4, count_, sure_);
    }
    /// Goes through them one after the other; the cut in the frame of the cluster.
    VECTORLIB_AVX2 VECTORLIB_INLINE void findPoint(double variance, Cut &cut) const {
        const Index g = four_;
        const float *const middle = points_ + BlockSums::block;
        const __m128 i = _mm_loadu_ps(points_ + 8 * g), j = _mm_loadu_ps(points_ + 8 * g + 4);
        const __m128 dx = _mm_shuffle_ps(i, j, 0x88) - _mm_broadcast_ss(middle);
        const __m128 dy = _mm_shuffle_ps(i, j, 0xdd) - _mm_broadcast_ss(middle + 1);
        // Ahead from no point to three of them, back from one to four.
        const auto running = [g](__m128 v, const double *before) VECTORLIB_AVX2 {
            return _mm256_cvtps_pd(simd::runningFourAvx2(back ? v : simd::shiftedAvx2<1>(v))) +
                   _mm256_broadcast_sd(before + g);
        };
        const __m256d n =
            _mm256_set1_pd(n_ + double(4 * g)) + _mm256_setr_pd(back, 1 + back, 2 + back, 3 + back);
        const __m256d x = running(dx, x_), y = running(dy, y_), xx = running(dx * dx, xx_),
                      yy = running(dy * dy, yy_), xy = running(dx * dy, xy_);
        const unsigned bits = fittingAvx2<true>({n, x, y, xx, yy, xy}, variance);
        const Index k = choosePoint<back>(back ? bits : bits >> 1, g, count_, sure_);
        const __m256d ox = _mm256_set1_pd(ox_), oy = _mm256_set1_pd(oy_);
        const __m256d cx = _mm256_fmadd_pd(n, ox, x), cy = _mm256_fmadd_pd(n, oy, y);
        const __m256d cxx = _mm256_fmadd_pd(ox, x + cx, xx), cyy = _mm256_fmadd_pd(oy, y + cy, yy),
                      cxy = _mm256_fmadd_pd(ox, cy, _mm256_fmadd_pd(oy, x, xy));
        const __m256i lane = _mm256_castsi128_si256(_mm_loadu_si64(lanes + 2 * (k - back)));
        const auto put = [lane](double before, __m256d s, double &to) VECTORLIB_AVX2 {
            s = _mm256_set1_pd(before) + s;
            to = _mm256_cvtsd_f64(_mm256_castps_pd(_mm256_permutevar8x32_ps(_mm256_castpd_ps(s), lane)));
        };
        cut.index = static_cast<std::size_t>(begin_ + 4 * g + k);
        put(from_.row.x, cx, cut.row.x);
        put(from_.row.y, cy, cut.row.y);
        put(from_.row.xx, cxx, cut.row.xx);
        put(from_.row.yy, cyy, cut.row.yy);
        put(from_.row.xy, cxy, cut.row.xy);
    }

private:
    static constexpr int lanes[8] = {0, 1, 2, 3, 4, 5, 6, 7}; // the two halves of each lane of doubles

    /// Running sums of eight values behind sums[0], the sum before them.
    VECTORLIB_AVX2 VECTORLIB_INLINE static void putRunning(__m256 v, double before, double *sums) {
        v = simd::runningFourAvx2(v);
        const __m256d low = _mm256_cvtps_pd(_mm256_castps256_ps128(v)) + _mm256_set1_pd(before);
        sums[0] = before;
        _mm256_storeu_pd(sums + 1, low);
        _mm256_storeu_pd(sums + 5,
                         _mm256_cvtps_pd(_mm256_extractf128_ps(v, 1)) + _mm256_permute4x64_pd(low, 0xff));
    }
    VECTORLIB_AVX2 VECTORLIB_INLINE FourRows four(int i) const {
        return {_mm256_set1_pd(n_) + _mm256_setr_pd(4 * i, 4 * i + 4, 4 * i + 8, 4 * i + 12),
                _mm256_loadu_pd(x_ + i),
                _mm256_loadu_pd(y_ + i),
                _mm256_loadu_pd(xx_ + i),
                _mm256_loadu_pd(yy_ + i),
                _mm256_loadu_pd(xy_ + i)};
    }

    const Cut &from_;
    const float *points_;
    Index begin_, count_, sure_, four_;
    double n_, ox_, oy_;
    double x_[9], y_[9], xx_[9], yy_[9], xy_[9]; // every four points
};

/// The farthest row of which the interval from a cut fits; see BlockSearch.
template <std::size_t stride, bool back>
VECTORLIB_AVX2 VECTORLIB_INLINE Index farthestRowAvx2(const BlockSums &sums, const Cut &from,
                                                      double variance) {
    const Index at = Index(from.index), size = Index(stride), last = sums.lastRow();
    const Index start = back ? (at + size - 1) / size : at / size;
    Index good = stride > 1 ? start : start + (back ? -2 : 2);
    for (Index k = back ? start - 8 : start + 1; back ? good > 0 && k > -8 : good < last && k <= last;
         k += back ? -8 : 8) {
        const unsigned bits = fittingRowsAvx2<stride, back>(sums, k, from, variance);
        const Index row = k + farthestBit<back>(bits, good - k);
        good = back ? std::min(good, row) : std::max(good, row);
        if (isEnd<stride, back>(bits))
            break;
    }
    return good;
}

/// The twin of farthest() in both directions.
template <std::size_t stride>
VECTORLIB_AVX2 void findEndsAvx2(const BlockSums &sums, const Cut &first, const Cut &end, double variance,
                                 Cut &ahead, Cut &back) {
    const Index last = sums.lastRow();
    const Index a = farthestRowAvx2<stride, false>(sums, first, variance),
                b = farthestRowAvx2<stride, true>(sums, end, variance);
    if constexpr (stride == 1) {
        ahead = {static_cast<std::size_t>(std::min(a, last)), sums.table().row(std::min(a, last))};
        back = {static_cast<std::size_t>(std::max<Index>(b, 0)), sums.table().row(std::max<Index>(b, 0))};
    } else {
        EndBlockAvx2<false> there(sums, std::min(a, last - 1), first);
        EndBlockAvx2<true> here(sums, std::max<Index>(b - 1, 0), end);
        there.findFour(variance);
        here.findFour(variance);
        there.findPoint(variance, ahead);
        here.findPoint(variance, back);
        if (a >= last)
            ahead = {sums.size(), sums.table().row(last)};
        else
            giveTwo<false>(sums, first, ahead);
        if (b <= 0)
            back = {0, SumRow{}};
        else
            giveTwo<true>(sums, end, back);
    }
}

} // namespace vectorlib::blocks

#endif
