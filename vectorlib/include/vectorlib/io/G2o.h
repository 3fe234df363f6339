#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/graph/PoseGraph.h"

#include <iosfwd>

namespace vectorlib {

/// A graph in the format of g2o: `VERTEX_SE2 number x y theta` and `EDGE_SE2 from to x y theta` with the
/// upper triangle of the information matrix, multiplied by the weight of the constraint, in the frame of the
/// second pose as measured; metres, radians.
void writeG2o(std::ostream &out, const PoseGraph &graph);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/G2o.cpp")
