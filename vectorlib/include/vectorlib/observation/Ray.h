#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Vector2D.h"

#include <limits>

namespace vectorlib {

/// The distance at which a ray meets nothing.
constexpr double noHit = std::numeric_limits<double>::infinity();

/// How far from the origin a ray of unit direction meets the segment from begin to end, whichever side it
/// meets; metres. noHit where it passes by, runs along the segment, or begins on it.
inline double rayDistance(Vector2D<double> direction, Vector2D<double> begin, Vector2D<double> end) {
    const Vector2D<double> edge = end - begin;
    const double across = direction.cross(edge);
    if (across == 0)
        return noHit;
    const double distance = begin.cross(edge) / across;
    const double along = begin.cross(direction) / across; // 0 at begin, 1 at end
    return distance > 0 && along >= 0 && along <= 1 ? distance : noHit;
}

} // namespace vectorlib
