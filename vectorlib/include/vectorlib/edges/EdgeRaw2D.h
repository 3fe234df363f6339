#pragma once

#include "vectorlib/tls/TlsFit.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

/// An edge for computing: a line segment and the sums of the points that it stands for.
struct EdgeRaw2D {
    TlsSums sums;                  ///< of its points, in the frame of the segment
    LineSegment2D<double> segment; ///< free space on the left
    double sigma = 0;              ///< standard deviation of the points from the line; metres

    EdgeRaw2D() = default;
    EdgeRaw2D(const TlsSums &sums_, const LineSegment2D<double> &segment_, double sigma_)
        : sums(sums_)
        , segment(segment_)
        , sigma(sigma_) {}

    /// The edge in the frame into which t leads.
    friend EdgeRaw2D operator*(const Transformation2D &t, EdgeRaw2D e) {
        e.sums = t * e.sums;
        e.segment = t * e.segment;
        return e;
    }
};

/// The edge of the union of both point sets: exact total least squares by added sums, reaching from the
/// outermost to the outermost end, directed as the first. Both in the same frame. Without a direction
/// (isotropic points) the first edge's segment stays.
inline EdgeRaw2D merged(const EdgeRaw2D &edge, const EdgeRaw2D &other) {
    EdgeRaw2D result(edge.sums + other.sums, edge.segment, edge.sigma);
    const TlsLine fit = fitLine(result.sums);
    if (!fit.line.isValid())
        return result;
    Vector2D<double> direction = fit.line.direction();
    if (direction.dot(edge.segment.direction()) < 0)
        direction = -direction;
    double from = 0, to = 0;
    const Vector2D<double> &mean = result.sums.mean;
    for (Vector2D<double> p :
         {edge.segment.begin(), edge.segment.end(), other.segment.begin(), other.segment.end()}) {
        const double t = (p - mean).dot(direction);
        from = std::min(from, t);
        to = std::max(to, t);
    }
    result.segment = {mean + direction * from, mean + direction * to, direction};
    result.sigma = std::sqrt(fit.variance);
    return result;
}

} // namespace vectorlib
