#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/tls/TlsSums.h"

#include <cstdint>

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
EdgeRaw2D merged(const EdgeRaw2D &edge, const EdgeRaw2D &other);

/// An edge of a map: all points ever seen on it by their sums (map frame), the segment they make, and how
/// often it was seen.
struct MapEdge : EdgeRaw2D {
    std::int64_t id = 0;           ///< its number in the map; no other edge has it
    std::int64_t observations = 0; ///< scans that saw it; 0 when it was merged into another

    MapEdge() = default;
    MapEdge(std::int64_t id_, const EdgeRaw2D &edge, std::int64_t observations_)
        : EdgeRaw2D(edge)
        , id(id_)
        , observations(observations_) {}
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/edges/EdgeRaw2D.cpp")
