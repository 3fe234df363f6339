#include "vectorlib/mapping/MergeMap.h"

namespace vectorlib {

VECTORLIB_BODY void mergeMap(VectorMap &map, const std::vector<MapEdge> &added,
                             const Transformation2D &motion, double distance) {
    for (const MapEdge &edge : added) {
        const EdgeRaw2D moved = motion * static_cast<const EdgeRaw2D &>(edge);
        const LineSegment2D<double> &wall = moved.segment;
        int best = -1;
        double longest = 0;
        for (const int number : map.near(wall, distance)) {
            const LineSegment2D<double> &known = map.slots()[std::size_t(number)].segment;
            const double overlap = known.overlap(wall);
            if (known.direction().dot(wall.direction()) > 0.95 && overlap > longest &&
                known.meanSquareAcross(wall) <= distance * distance) {
                best = number;
                longest = overlap;
            }
        }
        if (best < 0 || !map.merge(best, moved, edge.observations))
            best = map.add(moved, edge.observations);
        map.consolidate(best);
    }
}

} // namespace vectorlib
