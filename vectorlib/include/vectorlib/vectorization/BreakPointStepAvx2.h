#pragma once

#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/simd/SumEights.h"
#include "vectorlib/vectorization/BreakPointErrors.h"

#include <utility>

#if defined(VECTORLIB_SIMD_AVX2)

namespace vectorlib {

/// The sums of squared distances of eight sets of points from their lines: the smaller eigenvalues of their
/// moments, by the determinant over the larger ones, which needs a double for the determinant alone.
VECTORLIB_AVX2 VECTORLIB_INLINE __m256 squaresOfEightAvx2(const FourRows &low, const FourRows &high) {
    __m128 det[2], trace[2], square[2], n[2];
    for (int i = 0; i < 2; ++i) {
        const FourRows &s = i ? high : low;
        // Everything is n times too large.
        const __m256d a = _mm256_fmsub_pd(s.n, s.xx, s.x * s.x), b = _mm256_fmsub_pd(s.n, s.yy, s.y * s.y),
                      c = _mm256_fmsub_pd(s.n, s.xy, s.x * s.y), cc = c * c, d = a - b;
        det[i] = _mm256_cvtpd_ps(_mm256_max_pd(_mm256_fmsub_pd(a, b, cc), _mm256_setzero_pd()));
        trace[i] = _mm256_cvtpd_ps(a + b);
        square[i] = _mm256_cvtpd_ps(_mm256_fmadd_pd(d, d, _mm256_set1_pd(4) * cc));
        n[i] = _mm256_cvtpd_ps(s.n);
    }
    const __m256 larger =
        _mm256_set_m128(trace[1], trace[0]) + _mm256_sqrt_ps(_mm256_set_m128(square[1], square[0])); // twice
    const __m256 dets = _mm256_set_m128(det[1], det[0]);
    return (dets + dets) / (_mm256_set_m128(n[1], n[0]) * larger);
}

/// Looks at three places on both sides of a cut between two others, `stride` (1 or 4) points apart, and goes
/// to the one that leaves the least error, if that is less than here. The other cuts are more than 4 stride
/// points away. The points between are added up in float. In three parts, so that two cuts can go side by
/// side.
template <int stride>
class BreakPointStepAvx2 {
public:
    VECTORLIB_AVX2 VECTORLIB_INLINE BreakPointStepAvx2(PointSpan<float> points, Vector2D<double> origin,
                                                       Cut *cut)
        : cut_(cut) {
        before_.n = _mm256_setr_pd(-3 * stride, -2 * stride, -stride, 0);
        behind_.n = _mm256_setr_pd(stride, 2 * stride, 3 * stride, 4 * stride);
        // In the frame of the point behind the cut.
        const Vector2D<float> middle = points[cut->index];
        ox_ = middle.x - origin.x;
        oy_ = middle.y - origin.y;
        const float *const begin = &(points.begin() + cut->index - 4 * stride)->x;
        const __m256 mx = _mm256_set1_ps(middle.x), my = _mm256_set1_ps(middle.y);
        const simd::EightSums s =
            stride == 1 ? simd::sumOnesAvx2(begin, mx, my) : simd::sumFoursAvx2(begin, mx, my);
        run(s.x, before_.x, behind_.x, ways_[0]);
        run(s.y, before_.y, behind_.y, ways_[1]);
        run(s.xx, before_.xx, behind_.xx, ways_[2]);
        run(s.yy, before_.yy, behind_.yy, ways_[3]);
        run(s.xy, before_.xy, behind_.xy, ways_[4]);
    }
    VECTORLIB_AVX2 VECTORLIB_INLINE void choose() {
        const double left = number(cut_[-1], cut_[0]), right = number(cut_[0], cut_[1]);
        const SumRow l = inFrameAvx2(cut_[0].row - cut_[-1].row, left, ox_, oy_),
                     r = inFrameAvx2(cut_[1].row - cut_[0].row, right, ox_, oy_);
        __m256 squares = squaresOfEightAvx2(plus(left, l, before_), plus(left, l, behind_)) +
                         squaresOfEightAvx2(minus(right, r, before_), minus(right, r, behind_));
        // The eighth place would be one too far.
        squares = _mm256_blend_ps(squares, _mm256_set1_ps(HUGE_VALF), 0x80);
        __m256 least = _mm256_min_ps(squares, _mm256_permute2f128_ps(squares, squares, 1));
        least = _mm256_min_ps(least, _mm256_permute_ps(least, 0x4e));
        least = _mm256_min_ps(least, _mm256_permute_ps(least, 0xb1));
        const unsigned bits =
            static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(squares, least, _CMP_EQ_OQ)));
        // The cut stays where nothing is better, or nothing at all where a point is not finite. No branches:
        // nobody could foretell them.
        const unsigned here = (bits >> 3 & 1) | (bits == 0);
        best_ = static_cast<int>(simd::lowestBit((bits & (here - 1)) | here << 3));
    }
    /// False when the best place is at the border of what was looked at.
    VECTORLIB_AVX2 VECTORLIB_INLINE bool go() const {
        const double n = (best_ - 3) * stride, x = ways_[0][best_], y = ways_[1][best_];
        const double dx = x + n * ox_, dy = y + n * oy_;
        cut_->index += static_cast<std::size_t>(std::ptrdiff_t((best_ - 3) * stride));
        cut_->row.x += dx;
        cut_->row.y += dy;
        cut_->row.xx += ways_[2][best_] + ox_ * (x + dx);
        cut_->row.yy += ways_[3][best_] + oy_ * (y + dy);
        cut_->row.xy += ways_[4][best_] + ox_ * dy + oy_ * x;
        return best_ > 0 && best_ < 6;
    }

private:
    // The first half of the places lies before the cut, up to the cut itself.
    VECTORLIB_AVX2 VECTORLIB_INLINE static void run(__m256 v, __m256d &before, __m256d &behind,
                                                    double *ways) {
        v = simd::runningFourAvx2(v);
        const __m256d low = _mm256_cvtps_pd(_mm256_castps256_ps128(v));
        before = _mm256_blend_pd(low - _mm256_permute4x64_pd(low, 0xff), _mm256_setzero_pd(), 8);
        behind = _mm256_cvtps_pd(_mm256_extractf128_ps(v, 1));
        _mm256_storeu_pd(ways, before);
        _mm256_storeu_pd(ways + 4, behind);
    }
    VECTORLIB_INLINE static double number(const Cut &first, const Cut &end) {
        return static_cast<double>(static_cast<std::ptrdiff_t>(end.index - first.index));
    }
    VECTORLIB_AVX2 VECTORLIB_INLINE static FourRows plus(double n, const SumRow &r, const FourRows &w) {
        return {_mm256_set1_pd(n) + w.n,     _mm256_set1_pd(r.x) + w.x,   _mm256_set1_pd(r.y) + w.y,
                _mm256_set1_pd(r.xx) + w.xx, _mm256_set1_pd(r.yy) + w.yy, _mm256_set1_pd(r.xy) + w.xy};
    }
    VECTORLIB_AVX2 VECTORLIB_INLINE static FourRows minus(double n, const SumRow &r, const FourRows &w) {
        return {_mm256_set1_pd(n) - w.n,     _mm256_set1_pd(r.x) - w.x,   _mm256_set1_pd(r.y) - w.y,
                _mm256_set1_pd(r.xx) - w.xx, _mm256_set1_pd(r.yy) - w.yy, _mm256_set1_pd(r.xy) - w.xy};
    }

    Cut *cut_;
    double ox_, oy_;
    FourRows before_, behind_; // the sums of the points up to each place, with the sign of the way
    double ways_[5][8];        // their columns
    int best_ = 3;
};

/// A step of one cut, or of two that have no line in common. False where it is to be repeated.
template <int stride>
VECTORLIB_AVX2 bool stepAvx2(PointSpan<float> points, Vector2D<double> origin, Cut *cut) {
    BreakPointStepAvx2<stride> step(points, origin, cut);
    step.choose();
    return step.go();
}
template <int stride>
VECTORLIB_AVX2 std::pair<bool, bool> stepAvx2(PointSpan<float> points, Vector2D<double> origin, Cut *a,
                                              Cut *b) {
    BreakPointStepAvx2<stride> first(points, origin, a), second(points, origin, b);
    first.choose();
    second.choose();
    const bool isSettled = first.go();
    return {isSettled, second.go()};
}

} // namespace vectorlib

#endif
