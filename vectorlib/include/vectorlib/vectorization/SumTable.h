#pragma once

#include "vectorlib/simd/Simd.h"
#include "vectorlib/tls/TlsSums.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

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

/// The sums of all points before certain points of a cluster, one row for each of these, stored by column so
/// that four rows make one SIMD register. There are `margin` more rows on both sides for those who read eight
/// at a time.
class SumTable {
public:
    static constexpr std::ptrdiff_t margin = 8;

    /// Makes room for so many rows. Those in front of the first are 0; the others have no value yet.
    void reset(std::size_t rows) {
        rows += 2 * margin;
        if (rows > capacity_) {
            capacity_ = rows + rows / 2;
            memory_.assign(5 * capacity_, 0);
        }
    }
    // The columns, see SumRow.
    double *x() { return memory_.data() + margin; }
    double *y() { return x() + capacity_; }
    double *xx() { return x() + 2 * capacity_; }
    double *yy() { return x() + 3 * capacity_; }
    double *xy() { return x() + 4 * capacity_; }
    const double *x() const { return memory_.data() + margin; }
    const double *y() const { return x() + capacity_; }
    const double *xx() const { return x() + 2 * capacity_; }
    const double *yy() const { return x() + 3 * capacity_; }
    const double *xy() const { return x() + 4 * capacity_; }

    /// Writes row i.
    void set(std::ptrdiff_t i, const SumRow &sums) {
        x()[i] = sums.x;
        y()[i] = sums.y;
        xx()[i] = sums.xx;
        yy()[i] = sums.yy;
        xy()[i] = sums.xy;
    }
    /// Row i once more for all that follow: whoever reads eight rows at a time finds the last one again.
    void repeat(std::ptrdiff_t i) {
        for (double *column : {x(), y(), xx(), yy(), xy()})
            std::fill_n(column + i + 1, margin, column[i]);
    }
    VECTORLIB_INLINE SumRow row(std::ptrdiff_t i) const {
        return {x()[i], y()[i], xx()[i], yy()[i], xy()[i]};
    }

private:
    std::vector<double> memory_;
    std::size_t capacity_ = 0;
};

} // namespace vectorlib
