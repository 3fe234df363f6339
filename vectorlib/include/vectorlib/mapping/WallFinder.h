#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/SegmentGrid.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/mapping/VectorMap.h"

#include <cstdint>
#include <vector>

namespace vectorlib {

/// Which wall of a map an edge lies on. Looks at the map as it was indexed last.
class WallFinder {
public:
    double maxAngle = 0.17;    ///< between the two; radians
    double maxDistance = 0.15; ///< of the edge from the wall's line, root mean square; metres

    /// Takes the walls of a map as they are now.
    void index(const VectorMap &map);
    /// The id of the nearest wall beside at least half of the edge (map frame) that faces the same way; -1
    /// where there is none.
    std::int64_t operator()(const LineSegment2D<double> &edge);

private:
    struct Wall {
        std::int64_t id;
        LineSegment2D<double> segment;
    };
    std::vector<Wall> walls_;
    SegmentGrid grid_{0.5};
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/WallFinder.cpp")
