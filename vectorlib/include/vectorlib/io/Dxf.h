#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/MapEdge.h"

#include <iosfwd>
#include <vector>

namespace vectorlib {

/// A map as a DXF drawing (release 12, which every CAD program reads): one LINE a segment on layer MAP, one
/// unit a metre.
void writeDxf(std::ostream &out, const std::vector<MapEdge> &map);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/Dxf.cpp")
