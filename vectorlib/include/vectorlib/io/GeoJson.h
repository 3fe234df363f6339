#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/MapEdge.h"

#include <iosfwd>
#include <vector>

namespace vectorlib {

/// A map as GeoJSON: one LineString a segment. Coordinates are metres in the map's own frame, not degrees.
void writeGeoJson(std::ostream &out, const std::vector<MapEdge> &map);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/GeoJson.cpp")
