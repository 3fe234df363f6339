#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/tls/TlsSums.h"

namespace vectorlib {

/// An edge for computing: a line segment and the sums of the points that it stands for.
struct EdgeRaw2D {
    TlsSums sums;                  ///< of its points, in the frame of the segment
    LineSegment2D<double> segment; ///< free space on the left
    double sigma = 0;              ///< standard deviation of the points from the line; metres

    EdgeRaw2D() = default;
    EdgeRaw2D(const TlsSums &sums_, const LineSegment2D<double> &segment_, double sigma_);

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

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/edges/EdgeRaw2D.cpp")
