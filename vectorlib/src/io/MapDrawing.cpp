#include "vectorlib/io/MapDrawing.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/io/Svg.h"

namespace vectorlib {

VECTORLIB_BODY void writeDxf(std::ostream &out, const std::vector<MapEdge> &map) {
    out << "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
    for (const MapEdge &m : map) {
        const auto a = m.segment.begin(), b = m.segment.end();
        out << "0\nLINE\n8\nMAP\n10\n"
            << Number(a.x) << "\n20\n"
            << Number(a.y) << "\n30\n0\n11\n"
            << Number(b.x) << "\n21\n"
            << Number(b.y) << "\n31\n0\n";
    }
    out << "0\nENDSEC\n0\nEOF\n";
}

VECTORLIB_BODY void writeGeoJson(std::ostream &out, const std::vector<MapEdge> &map) {
    out << "{\"type\": \"FeatureCollection\", \"units\": \"metres in the frame of the map\", \"features\": [";
    const char *separator = "\n";
    for (const MapEdge &m : map) {
        const auto a = m.segment.begin(), b = m.segment.end();
        out << separator << R"({"type": "Feature", "id": )" << m.id
            << R"(, "geometry": {"type": "LineString", "coordinates": [[)" << Number(a.x) << ", "
            << Number(a.y) << "], [" << Number(b.x) << ", " << Number(b.y) << R"(]]}, "properties": {"n": )"
            << Number(m.sums.n) << R"(, "sigma": )" << Number(m.sigma) << R"(, "observations": )"
            << m.observations << "}}";
        separator = ",\n";
    }
    out << "\n]}\n";
}

VECTORLIB_BODY void drawMap(std::ostream &out, const MapDrawing &map) {
    SvgPicture picture(map.title);
    const auto draw = [&](SvgPicture::Style style, const std::vector<StampedPose> &poses) {
        std::vector<Vector2D<double>> path;
        for (const StampedPose &p : poses) {
            if (p.isApart) {
                picture.path(style, path);
                style.label.clear();
                path.clear();
            }
            path.emplace_back(p.pose.x, p.pose.y);
        }
        if (!path.empty())
            picture.path(style, path);
    };
    draw({colour::reference, 1.5, "reference trajectory", true}, map.reference);
    draw({colour::estimate, 1.2, "trajectory"}, map.trajectory);
    // What only one or two scans saw is drawn lighter: people and things that moved, or noise.
    std::vector<LineSegment2D<double>> seldom, often;
    for (const MapEdge &m : map.segments)
        (m.observations < 3 ? seldom : often).push_back(m.segment);
    if (!seldom.empty())
        picture.segments({colour::points, 1.2, "seen once or twice: " + std::to_string(seldom.size())},
                         seldom);
    picture.segments({colour::map, 1.8, "map segments seen more often: " + std::to_string(often.size())},
                     often);
    if (!map.trajectory.empty()) {
        const Pose2D &first = map.trajectory.front().pose, &last = map.trajectory.back().pose;
        picture.pose({"#009e73", 2, "start"}, {first.x, first.y}, first.theta);
        picture.pose({"#d55e00", 2, "end"}, {last.x, last.y}, last.theta);
    }
    picture.write(out);
}

} // namespace vectorlib
