#include "vectorlib/io/MapDrawing.h"

#include "vectorlib/io/Svg.h"

namespace vectorlib {

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
