#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/tls/TlsSums.h"

#include <cstdint>

namespace vectorlib {

/// An edge of a map as files hold it.
struct MapSegment {
    std::int64_t id = 0;
    LineSegment2D<double> segment; ///< map frame, metres; free space on the left
    TlsSums sums;                  ///< of all points of the edge, map frame: what makes merging exact
    double sigma = 0;              ///< standard deviation of the points from the line; metres
    std::int64_t observations = 0; ///< scans that saw the edge
};

} // namespace vectorlib
