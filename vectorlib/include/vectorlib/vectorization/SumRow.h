#pragma once

#include "vectorlib/simd/Simd.h"
#include "vectorlib/tls/TlsSums.h"

#include <cmath>

namespace vectorlib {

/// The five plain sums of thesis (6.23), (6.24) of the points before some point, in the frame of a cluster's
/// first point (erratum 3). Not set to 0 unless written SumRow{}: the search keeps a few of them on its
/// stack.
struct SumRow {
    double x, y, xx, yy, xy;

    /// Adds a point.
    void add(double px, double py) {
        x += px;
        y += py;
        xx += px * px;
        yy += py * py;
        xy += px * py;
    }
    /// The same of these n points in the frame of `origin`.
    SumRow inFrame(double n, Vector2D<double> origin) const {
        const double px = x - n * origin.x, py = y - n * origin.y;
        return {px, py, xx - origin.x * (x + px), yy - origin.y * (y + py),
                xy - origin.x * y - origin.y * px};
    }
    friend SumRow operator+(const SumRow &a, const SumRow &b) {
        return {a.x + b.x, a.y + b.y, a.xx + b.xx, a.yy + b.yy, a.xy + b.xy};
    }
    friend SumRow operator-(const SumRow &a, const SumRow &b) {
        return {a.x - b.x, a.y - b.y, a.xx - b.xx, a.yy - b.yy, a.xy - b.xy};
    }
};

#if defined(VECTORLIB_SIMD_AVX2)
/// Four rows, and how many points each stands for.
struct FourRows {
    __m256d n, x, y, xx, yy, xy;
};
/// SumRow::inFrame().
VECTORLIB_AVX2 VECTORLIB_INLINE SumRow inFrameAvx2(const SumRow &s, double n, double x, double y) {
    const double sx = std::fma(-n, x, s.x), sy = std::fma(-n, y, s.y);
    return {sx, sy, std::fma(-x, s.x + sx, s.xx), std::fma(-y, s.y + sy, s.yy),
            std::fma(-x, s.y, std::fma(-y, sx, s.xy))};
}
#endif

/// The threshold test of n points with these sums: whether they lie within the root of `variance` of their
/// line, that is whether the smaller eigenvalue of their scatter about the mean (thesis 6.22) is at most n
/// variance. Neither root nor division: everything is n times too large.
struct ThresholdTest {
    double trace, det, margin;

    /// `error` (relative to the scatter's trace, and absolute) is how far the eigenvalue may be off.
    ThresholdTest(double n, const SumRow &s, double variance, double relative, double absolute) {
        const double limit = n * n * variance;
        const double a = n * s.xx - s.x * s.x - limit, b = n * s.yy - s.y * s.y - limit;
        const double c = n * s.xy - s.x * s.y;
        trace = a + b;
        det = a * b - c * c;
        // A limit changed by e changes the determinant by e trace + e^2 at most.
        const double e = relative * (trace + 2 * limit) + n * absolute;
        margin = e * (std::abs(trace) + e);
    }
    /// Whether an error may decide; NaN is clear.
    bool isUnclear() const { return std::abs(det) <= margin; }
    bool fits() const { return !((det > 0) & (trace > 0)); }
};

} // namespace vectorlib
