#include "gui/vector/MapFiles.h"

#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "vectorlib/io/MapCsv.h"
#include "vectorlib/io/Pgm.h"

#include <filesystem>
#include <set>

namespace hermes::vector {

CLI::Validator MapFile::knownName() {
    const auto check = [](const std::string &path) {
        static const std::set<std::string> known{".csv", ".svg", ".geojson", ".dxf", ".pgm"};
        return known.count(std::filesystem::u8path(path).extension().u8string()) > 0
                   ? std::string()
                   : "found " + path + ", expected a name that ends with .csv, .svg, .geojson, .dxf or .pgm";
    };
    return {check, ""};
}

MapFile::MapFile(OutputSet &files, const std::string &path)
    : path_(path)
    , out_(&files.open(path)) {
    if (hasExtension(path, ".pgm"))
        yaml_ = &files.open(std::filesystem::u8path(path).replace_extension(".yaml").u8string());
}

void MapFile::write(const vectorlib::MapDrawing &map) {
    if (hasExtension(path_, ".csv")) {
        vectorlib::writeMapCsv(*out_, map.segments);
    } else if (hasExtension(path_, ".geojson")) {
        vectorlib::writeGeoJson(*out_, map.segments);
    } else if (hasExtension(path_, ".dxf")) {
        vectorlib::writeDxf(*out_, map.segments);
    } else if (hasExtension(path_, ".svg")) {
        drawMap(*out_, map);
    } else {
        const auto picture = vectorlib::OccupancyPicture::draw(map.segments, map.trajectory);
        if (!picture)
            throw Failure(path_ + ": found a map too large to draw, expected at most " +
                          std::to_string(vectorlib::OccupancyPicture::maxCells) + " cells of 5 cm");
        picture->writePgm(*out_);
        picture->writeYaml(*yaml_, std::filesystem::u8path(path_).filename().u8string());
    }
}

std::vector<vectorlib::MapEdge> loadMap(const std::string &path) {
    Input input(path);
    std::vector<vectorlib::MapEdge> map = valueOrFail(vectorlib::readMapCsv(input.stream(), input.name()));
    if (map.empty())
        throw Failure(input.name() + ": found a map without a wall, expected at least one");
    return map;
}

} // namespace hermes::vector
