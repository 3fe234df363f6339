#pragma once

#include "vectorlib/mapping/VectorMap.h"

namespace vectorlib {

/// Adds a map, moved, to another one: walls that both have become one by their sums, their observations are
/// added, and the others are new. Walls farther apart than `distance` (root mean square, metres) stay two.
inline void mergeMap(VectorMap &map, const std::vector<MapEdge> &added, const Transformation2D &motion,
                     double distance = 0.10) {
    const Vector2D<double> margin(distance, distance);
    for (const MapEdge &edge : added) {
        const EdgeRaw2D moved = motion * static_cast<const EdgeRaw2D &>(edge);
        const LineSegment2D<double> &wall = moved.segment;
        const Vector2D<double> a = wall.begin(), b = wall.end();
        const Vector2D<double> low(std::min(a.x, b.x), std::min(a.y, b.y)),
            high(std::max(a.x, b.x), std::max(a.y, b.y));
        int best = -1;
        double longest = 0;
        for (const int number : map.near(low - margin, high + margin)) {
            const LineSegment2D<double> &known = map.slots()[std::size_t(number)].segment;
            const double from = known.across(a), to = known.across(b), overlap = known.overlap(wall);
            if (known.direction().dot(wall.direction()) > 0.95 && overlap > longest &&
                from * from + from * to + to * to <= 3 * distance * distance) {
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
