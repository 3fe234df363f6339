#pragma once

#include "gui/vector/Output.h"
#include "vectorlib/io/MapDrawing.h"

#include <CLI/CLI.hpp>

namespace hermes::vector {

/// A map file whose kind follows from its extension: csv, svg, geojson, dxf, pgm (with a yaml file beside
/// it).
class MapFile {
public:
    /// Lets only names of these kinds through.
    static CLI::Validator knownName();

    /// Opens the file (and the second one of pgm); throws Failure as OutputSet::open does.
    MapFile(OutputSet &files, const std::string &path);
    void write(const vectorlib::MapDrawing &map);

private:
    std::string path_;
    std::ostream *out_;
    std::ostream *yaml_ = nullptr;
};

/// A map in a CSV file with sums, as `map` writes it; throws Failure where it cannot be read or is empty.
std::vector<vectorlib::MapEdge> loadMap(const std::string &path);

} // namespace hermes::vector
