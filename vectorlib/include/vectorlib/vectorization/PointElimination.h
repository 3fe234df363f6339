#pragma once

#include "vectorlib/vectorization/VectorizedLine.h"

#include <vector>

namespace vectorlib {

/// Settings of the vectorizers that keep some of the points and drop the others (thesis 6.1.2).
struct PointEliminationSettings : VectorizerSettings {
    double sigmas = 3;   ///< the largest distance of a dropped point, in units of sigma (thesis 6.5)
    bool measure = true; ///< fill the lines' sums and sigma, which the algorithms themselves do not need

    /// Largest distance of a dropped point from its line; metres. 0 when sigma is negative or no number.
    double tolerance() const { return std::max(0.0, sigmas * std::max(0.0, sigma)); }
};

/// The line through two points with c >= 0; invalid when they are one.
inline Line2D lineThrough(Vector2D<double> from, Vector2D<double> to) {
    Vector2D<double> normal = (to - from).normalized().left();
    double c = -normal.dot(from);
    if (c < 0) {
        normal = -normal;
        c = -c;
    }
    if (!(std::abs(normal.squaredNorm() - 1) < 1e-6) || !std::isfinite(c)) // none, or out of range
        return {};
    return {normal.x, normal.y, c};
}

/// The lines between consecutive kept points (indices, ascending, the first and the last point among them). A
/// kept point is the end of one line and the begin of the next, and counted with the next, so that every
/// point belongs to one interval; an interval can be a single point. Sigma is measured from the line through
/// the kept points.
template <typename Scalar>
void linesThrough(PointSpan<Scalar> points, const std::vector<std::size_t> &kept,
                  const PointEliminationSettings &settings, std::vector<VectorizedLine> &lines) {
    for (std::size_t i = 0; i + 1 < kept.size(); ++i) {
        const bool isLast = i + 2 == kept.size();
        VectorizedLine v;
        v.first = kept[i];
        v.last = isLast ? kept[i + 1] : kept[i + 1] - 1;
        const Vector2D<double> from(points[kept[i]]), to(points[kept[i + 1]]);
        v.line = lineThrough(from, to);
        if ((to - from).isFinite() && from.isFinite())
            v.segment = {from, to};
        if (settings.measure) {
            const TlsSums sums = TlsSums::of(points.begin() + v.first, points.begin() + v.last + 1);
            const double a = v.line.a, b = v.line.b, across = v.line.signedDistance(sums.mean);
            const double squares = a * a * sums.xx + 2 * a * b * sums.xy + b * b * sums.yy;
            const double sigma = std::sqrt(std::max(0.0, squares / sums.n) + across * across);
            if (isFinite(sums) && std::isfinite(sigma)) {
                v.sums = sums;
                v.sigma = sigma;
            }
        }
        lines.push_back(v);
    }
}

} // namespace vectorlib
