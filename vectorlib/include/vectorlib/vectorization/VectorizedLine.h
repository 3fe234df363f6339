#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/tls/TlsFit.h"
#include "vectorlib/vectorization/SumTable.h"

#include <cstddef>

namespace vectorlib {

/// Where one interval of points ends and the next begins, and the sums of all points before.
struct Cut {
    std::size_t index;
    SumRow row;
};

/// The sums of the points between two cuts, whose rows are in the frame of `origin`.
inline TlsSums sumsBetween(const Cut &first, const Cut &end, Vector2D<double> origin) {
    const SumRow s = end.row - first.row;
    return TlsSums::fromPlain(static_cast<double>(end.index - first.index), s.x, s.y, s.xx, s.xy, s.yy,
                              origin);
}

/// One line that a vectorizer found, with the points it stands for.
struct VectorizedLine {
    std::size_t first = 0;         ///< index of its first point
    std::size_t last = 0;          ///< index of its last point, inclusive
    TlsSums sums;                  ///< of these points
    Line2D line;                   ///< total least squares; invalid when the points have no direction
    double sigma = 0;              ///< standard deviation of the points from the line; metres
    LineSegment2D<double> segment; ///< the part of the line, or an edge of the polyline, see Polyline.h
};

/// Fits the line of points first .. last (sums given) and cuts it at their projections. Where one of the
/// points is not finite the line is invalid and its sums are empty, never NaN.
template <typename Scalar>
VectorizedLine makeLine(PointSpan<Scalar> points, std::size_t first, std::size_t last, const TlsSums &sums) {
    VectorizedLine v;
    v.first = first;
    v.last = last;
    if (!isFinite(sums))
        return v;
    v.sums = sums;
    const TlsLine fit = fitLine(sums);
    v.line = fit.line;
    v.sigma = std::sqrt(fit.variance);
    Vector2D<double> begin(points[first]), end(points[last]);
    if (fit.line.isValid()) {
        begin = fit.line.project(begin);
        end = fit.line.project(end);
        // The direction is that of the line: no further root.
        const Vector2D<double> along(-fit.line.b, fit.line.a);
        if (const double length = along.dot(end - begin); length != 0) {
            v.segment = LineSegment2D<double>(begin, end, length > 0 ? along : -along);
            return v;
        }
    }
    v.segment = LineSegment2D<double>(begin, end);
    return v;
}

/// Settings that all vectorizers share.
struct VectorizerSettings {
    double sigma = 0.02; ///< largest standard deviation of points from their line; metres
    /// Largest distance of a polyline's corner from the break point, see Polyline.h; metres. About five times
    /// sigma: less interrupts polylines, more draws corners away from the points.
    double delta = 0.10;
    bool polyline =
        true; ///< join consecutive lines at their intersections (thesis 6.3.3); else cut at end points

    /// The square of sigma; 0 for a sigma that is negative or no number: then only exact lines are accepted.
    double variance() const {
        const double s = std::max(0.0, sigma);
        return s * s;
    }
};

} // namespace vectorlib
