#pragma once

#include "gui/vector/Output.h"
#include "vectorlib/io/MapDrawing.h"

namespace hermes::vector {

/// A map file whose kind follows from its extension: csv, svg, geojson, dxf, pgm (with a yaml file beside
/// it).
class MapFile {
public:
    /// The kinds, for messages and checks.
    static const std::vector<std::string> &extensions();
    static bool isKnown(const std::string &path);

    /// Opens the file (and the second one of pgm); throws Failure as OutputSet::open does.
    MapFile(OutputSet &files, const std::string &path);
    void write(const vectorlib::MapDrawing &map);

private:
    std::string path_;
    std::ostream *out_;
    std::ostream *yaml_ = nullptr;
};

} // namespace hermes::vector
