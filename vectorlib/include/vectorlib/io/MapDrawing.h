#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/MapEdge.h"
#include "vectorlib/io/Tum.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace vectorlib {

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
