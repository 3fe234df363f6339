#include "gui/vector/MapFiles.h"

#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "vectorlib/io/Dxf.h"
#include "vectorlib/io/GeoJson.h"
#include "vectorlib/io/MapCsv.h"
#include "vectorlib/io/Pgm.h"

#include <algorithm>
#include <filesystem>

namespace hermes {

const std::vector<std::string> &MapFile::extensions() {
    static const std::vector<std::string> known = {".csv", ".svg", ".geojson", ".dxf", ".pgm"};
    return known;
}

bool MapFile::isKnown(const std::string &path) {
    const std::string extension = std::filesystem::path(path).extension().string();
    return std::find(extensions().begin(), extensions().end(), extension) != extensions().end();
}

MapFile::MapFile(OutputSet &files, const std::string &path)
    : m_path(path)
    , m_out(&files.open(path)) {
    if (hasExtension(path, ".pgm"))
        m_yaml = &files.open(std::filesystem::path(path).replace_extension(".yaml").string());
}

void MapFile::write(const vectorlib::MapDrawing &map) {
    if (hasExtension(m_path, ".csv")) {
        vectorlib::writeMapCsv(*m_out, map.segments);
    } else if (hasExtension(m_path, ".geojson")) {
        vectorlib::writeGeoJson(*m_out, map.segments);
    } else if (hasExtension(m_path, ".dxf")) {
        vectorlib::writeDxf(*m_out, map.segments);
    } else if (hasExtension(m_path, ".svg")) {
        drawMap(*m_out, map);
    } else {
        const auto picture = vectorlib::OccupancyPicture::draw(map.segments, map.trajectory);
        if (!picture)
            throw Failure(m_path + ": found a map too large to draw, expected at most " +
                          std::to_string(vectorlib::OccupancyPicture::maxCells) + " cells of 5 cm");
        picture->writePgm(*m_out);
        picture->writeYaml(*m_yaml, std::filesystem::path(m_path).filename().string());
    }
}

} // namespace hermes
