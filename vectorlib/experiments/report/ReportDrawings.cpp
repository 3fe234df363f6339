#include "vectorlib/experiments/report/Report.h"

namespace hermes::experiments {

using Point = vectorlib::Vector2D<double>;

namespace {

constexpr std::size_t maxDots = 250; // of a scan in a picture

const Ink common{Ink::Kind::Area, "commonarea", "#b7d9c0", 0, "Common valid area"};
const Ink difference{Ink::Kind::Area, "discrepancyarea", "#f2a65a", 0, "Discrepancy area"};
const Ink dots{Ink::Kind::Dots, "scannedpoint", "#009e73", 1.4, "Scanned points"};
const Ink still{Ink::Kind::Lines, "staticscan", "#8d99ae", 2.6, "Static scan"};
const Ink registered{Ink::Kind::Lines, "registeredscan", "#111111", 1.2, "Registered scan"};
const Ink link{Ink::Kind::Lines, "correspondence", "#d62828", 1.0, "Correspondence"};
const Ink mapEdge{Ink::Kind::Lines, "mapedge", "#1b2a41", 1.4, "Map edges"};
const Ink robot{Ink::Kind::Pose, "robotpose", "#0072b2", 1.2, "Robot pose"};
const Ink path{Ink::Kind::Lines, "robotpath", "#56b4e9", 0.8, "Robot path", true};

std::vector<Point> thinned(const std::vector<vectorlib::Vector2D<float>> &points,
                           const vectorlib::Transformation2D &t) {
    std::vector<Point> result;
    const std::size_t step = points.size() / maxDots + 1;
    for (std::size_t i = 0; i < points.size(); i += step)
        result.push_back(t * Point(points[i]));
    return result;
}

} // namespace

std::vector<const Ink *> caseInks() {
    return {&still, &registered, &dots, &link, &common, &difference};
}

std::vector<const Ink *> overallInks() {
    return {&mapEdge, &robot, &path};
}

std::vector<const Ink *> allInks() {
    return {&still, &registered, &dots, &link, &common, &difference, &mapEdge, &robot, &path};
}

Drawing drawScans(const CaseReport &report) {
    Drawing drawing;
    drawing.dots(dots, thinned(report.scans.moving.points, {}));
    drawing.segments(still, report.scans.fixed.segments);
    drawing.segments(registered, report.scans.moving.segments);
    drawing.pose(robot, {});
    return drawing;
}

Drawing drawSolution(const CaseReport &report, const vectorlib::Solution &solution) {
    const VectorScan &fixed = report.scans.fixed, &moving = report.scans.moving;
    const vectorlib::Transformation2D origin, t = solution.pose;
    vectorlib::ExpectedViewTest compare;
    compare.setFixed(fixed.segments, &origin);
    compare.setMoving(moving.segments);
    compare(t);
    Drawing drawing;
    for (const vectorlib::SharedSector &s : compare.sectors()) {
        const bool expectedIsNear =
            s.expectedRight.cross(s.expectedLeft) < s.observedRight.cross(s.observedLeft);
        drawing.area(common, {t.translation(), t * (expectedIsNear ? s.expectedRight : s.observedRight),
                              t * (expectedIsNear ? s.expectedLeft : s.observedLeft)});
        drawing.area(difference,
                     {t * s.expectedRight, t * s.expectedLeft, t * s.observedLeft, t * s.observedRight});
    }
    drawing.dots(dots, thinned(moving.points, t));
    drawing.segments(still, fixed.segments);
    for (const vectorlib::LineSegment2D<double> &segment : moving.segments)
        drawing.segment(registered, t * segment);
    for (const vectorlib::CorrespondencePair &p : solution.pairs)
        drawing.segment(link, {fixed.segments[std::size_t(p.fixed)].middle(),
                               t * moving.segments[std::size_t(p.moving)].middle()});
    drawing.pose(robot, t.pose());
    return drawing;
}

Drawing drawWorld(const World &world) {
    Drawing drawing;
    drawing.segments(mapEdge, edgesOf(world));
    std::vector<Point> places;
    for (const vectorlib::Pose2D &pose : world.poses)
        places.emplace_back(pose.x, pose.y);
    drawing.path(path, places);
    for (const vectorlib::Pose2D &pose : world.poses)
        drawing.pose(robot, pose);
    return drawing;
}

} // namespace hermes::experiments
