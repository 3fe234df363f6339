#pragma once

#include "vectorlib/tls/TlsFit.h"

#include <array>
#include <string>
#include <vector>

namespace vectorlib {

struct Observation2D;

/// All that is known of one edge of one observation: its points, their sums, the segment, where it comes
/// from.
struct EdgeRich2D {
    std::vector<Vector2D<float>> points; ///< in the observation's frame, scanning order; metres
    TlsSums sums;
    LineSegment2D<double> segment; ///< free space on the left
    double sigma = 0;              ///< standard deviation of the points from the line; metres
    const Observation2D *observation = nullptr;
    std::string annotation;
};

/// The light form of an edge for computing: sums, segment and a link to the rich edge (may be null).
struct EdgeRaw2D {
    TlsSums sums;
    LineSegment2D<double> segment; ///< free space on the left
    double sigma = 0;              ///< metres
    const EdgeRich2D *rich = nullptr;

    EdgeRaw2D() = default;
    EdgeRaw2D(const TlsSums &sums_, const LineSegment2D<double> &segment_, double sigma_)
        : sums(sums_)
        , segment(segment_)
        , sigma(sigma_) {}
    explicit EdgeRaw2D(const EdgeRich2D &edge)
        : EdgeRaw2D(edge.sums, edge.segment, edge.sigma) {
        rich = &edge;
    }

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
