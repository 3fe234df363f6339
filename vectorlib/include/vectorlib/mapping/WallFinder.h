#pragma once

#include "vectorlib/mapping/VectorMap.h"

namespace vectorlib {

/// Which wall of a map an edge lies on. Looks at the map as it was indexed last.
class WallFinder {
public:
    double maxAngle = 0.17;    ///< between the two; radians
    double maxDistance = 0.15; ///< of the edge from the wall's line, root mean square; metres

    /// Takes the walls of a map as they are now.
    void index(const VectorMap &map) {
        grid_.clear();
        walls_.clear();
        map.forEach([this](const MapEdge &e) {
            walls_.push_back({e.id, e.segment});
            grid_.insert(static_cast<int>(walls_.size()) - 1, e.segment);
        });
    }
    /// The id of the nearest wall beside at least half of the edge (map frame) that faces the same way; -1
    /// where there is none.
    std::int64_t operator()(const LineSegment2D<double> &edge) {
        std::int64_t nearest = -1;
        double least = maxDistance * maxDistance;
        // A wall beside half of the edge lies beside its middle.
        const Vector2D<double> margin(maxDistance, maxDistance);
        grid_.query(edge.middle() - margin, edge.middle() + margin, [&](int number) {
            const auto &[id, wall] = walls_[static_cast<std::size_t>(number)];
            if (wall.direction().dot(edge.direction()) < std::cos(maxAngle) ||
                2 * edge.overlap(wall) < edge.length())
                return;
            const double square = wall.meanSquareAcross(edge);
            if (square < least || (square == least && id < nearest)) {
                least = square;
                nearest = id;
            }
        });
        return nearest;
    }

private:
    struct Wall {
        std::int64_t id;
        LineSegment2D<double> segment;
    };
    std::vector<Wall> walls_;
    SegmentGrid grid_{0.5};
};

} // namespace vectorlib
