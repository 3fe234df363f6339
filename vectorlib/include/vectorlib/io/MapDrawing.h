#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/io/Tum.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace vectorlib {

/// A map as a DXF drawing (release 12, which every CAD program reads): one LINE a segment on layer MAP, one
/// unit a metre.
void writeDxf(std::ostream &out, const std::vector<MapEdge> &map);

/// A map as GeoJSON: one LineString a segment. Coordinates are metres in the map's own frame, not degrees.
void writeGeoJson(std::ostream &out, const std::vector<MapEdge> &map);

/// A map and what belongs into a picture of it; metres, map frame.
struct MapDrawing {
    std::string title;
    std::vector<MapEdge> segments;
    std::vector<StampedPose> trajectory; ///< may be empty
    std::vector<StampedPose> reference;  ///< the true or a better trajectory; may be empty
};

/// Draws the map as SVG.
void drawMap(std::ostream &out, const MapDrawing &map);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/MapDrawing.cpp")
