#include "vectorlib/mapping/WallFinder.h"

namespace vectorlib {

VECTORLIB_BODY void WallFinder::index(const VectorMap &map) {
    grid_.clear();
    walls_.clear();
    map.forEach([this](const MapEdge &e) {
        walls_.push_back({e.id, e.segment});
        grid_.insert(static_cast<int>(walls_.size()) - 1, e.segment);
    });
}

VECTORLIB_BODY std::int64_t WallFinder::operator()(const LineSegment2D<double> &edge) {
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

} // namespace vectorlib
