#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/MapEdge.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/mapping/VectorMap.h"

#include <vector>

namespace vectorlib {

/// Adds a map, moved, to another one: walls that both have become one by their sums, their observations are
/// added, and the others are new. Walls farther apart than `distance` (root mean square, metres) stay two.
void mergeMap(VectorMap &map, const std::vector<MapEdge> &added, const Transformation2D &motion,
              double distance = 0.10);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/MergeMap.cpp")
