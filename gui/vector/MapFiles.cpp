#include "gui/vector/MapFiles.h"

#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "vectorlib/io/Dxf.h"
#include "vectorlib/io/GeoJson.h"
#include "vectorlib/io/MapCsv.h"
#include "vectorlib/io/Pgm.h"
#include "vectorlib/io/Svg.h"

#include <algorithm>
#include <filesystem>

namespace hermes {

namespace {

std::vector<vectorlib::Vector2D<double>> pathOf(const std::vector<vectorlib::StampedPose> &poses) {
    std::vector<vectorlib::Vector2D<double>> path;
    for (const vectorlib::StampedPose &p : poses)
        path.emplace_back(p.pose.x, p.pose.y);
    return path;
}

} // namespace

void drawMap(std::ostream &out, const MapDrawing &map) {
    vectorlib::SvgPicture picture(map.title);
    if (!map.reference.empty())
        picture.path({vectorlib::colour::reference, 1.5, "reference trajectory", true},
                     pathOf(map.reference));
    if (!map.trajectory.empty())
        picture.path({vectorlib::colour::estimate, 1.2, "trajectory"}, pathOf(map.trajectory));
    std::vector<vectorlib::LineSegment2D<double>> segments;
    for (const vectorlib::MapSegment &m : map.segments)
        segments.push_back(m.segment);
    picture.segments({vectorlib::colour::map, 1.8, "map: " + std::to_string(segments.size()) + " segments"},
                     segments);
    if (!map.trajectory.empty()) {
        const vectorlib::Pose2D &first = map.trajectory.front().pose, &last = map.trajectory.back().pose;
        picture.pose({"#009e73", 2, "start"}, {first.x, first.y}, first.theta);
        picture.pose({"#d55e00", 2, "end"}, {last.x, last.y}, last.theta);
    }
    picture.write(out);
}

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

void MapFile::write(const MapDrawing &map) {
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
