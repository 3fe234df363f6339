#pragma once

#include "gui/vector/Output.h"
#include "vectorlib/io/MapSegment.h"
#include "vectorlib/io/Tum.h"

namespace hermes {

/// A map and what belongs into a picture of it.
struct MapDrawing {
    std::string title;
    std::vector<vectorlib::MapSegment> segments;
    std::vector<vectorlib::StampedPose> trajectory;
    std::vector<vectorlib::StampedPose> reference; ///< may be empty
};

void drawMap(std::ostream &out, const MapDrawing &map);

/// A map file whose kind follows from its extension: csv, svg, geojson, dxf, pgm (with a yaml file beside
/// it).
class MapFile {
public:
    /// The kinds, for messages and checks.
    static const std::vector<std::string> &extensions();
    static bool isKnown(const std::string &path);

    /// Opens the file (and the second one of pgm); throws Failure as OutputSet::open does.
    MapFile(OutputSet &files, const std::string &path);
    void write(const MapDrawing &map);

private:
    std::string m_path;
    std::ostream *m_out;
    std::ostream *m_yaml = nullptr;
};

} // namespace hermes
