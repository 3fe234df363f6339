#pragma once

#include "gui/vector/Output.h"
#include "vectorlib/io/MapDrawing.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

namespace hermes::vector {

/// A map file whose kind follows from its extension: csv, svg, geojson, dxf, pgm (with a yaml file beside
/// it).
class MapFile {
public:
    /// The kinds, for messages and checks.
    static const std::vector<std::string> &extensions() {
        static const std::vector<std::string> known = {".csv", ".svg", ".geojson", ".dxf", ".pgm"};
        return known;
    }
    static bool isKnown(const std::string &path) {
        const std::string extension = std::filesystem::u8path(path).extension().u8string();
        return std::find(extensions().begin(), extensions().end(), extension) != extensions().end();
    }
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
