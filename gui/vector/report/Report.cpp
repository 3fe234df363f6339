#include "gui/vector/report/Report.h"

#include "vectorlib/io/Number.h"

#include <sstream>

namespace hermes::vector {

using Point = vectorlib::Vector2D<double>;
using vectorlib::Fixed;

namespace {

constexpr std::size_t mostDots = 500; // of a scan in a picture

const Ink common{Ink::Kind::Area, "commonarea", "#b7d9c0", 0, "common area"};
const Ink difference{Ink::Kind::Area, "discrepancyarea", "#f2a65a", 0, "discrepancy area"};
const Ink dots{Ink::Kind::Dots, "scannedpoint", "#009e73", 1.4, "scanned points"};
const Ink still{Ink::Kind::Lines, "staticscan", "#8d99ae", 2.6, "static scan"};
const Ink registered{Ink::Kind::Lines, "registeredscan", "#111111", 1.2, "registered scan"};
const Ink link{Ink::Kind::Lines, "correspondence", "#d62828", 1.0, "correspondence"};
const Ink mapEdge{Ink::Kind::Lines, "mapedge", "#1b2a41", 1.4, "edges of the world"};
const Ink robot{Ink::Kind::Pose, "robotpose", "#0072b2", 1.2, "pose of the robot"};
const Ink path{Ink::Kind::Lines, "robotpath", "#56b4e9", 0.8, "path of the robot", true};

std::vector<Point> thinned(const std::vector<vectorlib::Vector2D<float>> &points,
                           const vectorlib::Transformation2D &t) {
    std::vector<Point> result;
    const std::size_t step = points.size() / mostDots + 1;
    for (std::size_t i = 0; i < points.size(); i += step)
        result.push_back(t * Point(points[i]));
    return result;
}

std::string text(double value, int decimals, const char *unit = "") {
    std::ostringstream out;
    out << Fixed{value, decimals} << unit;
    return out.str();
}

} // namespace

CaseReport reportCase(const World &world, std::size_t number, const ReportSettings &settings) {
    ScanSettings scan = settings.scan;
    scan.seed = settings.scan.seed * 1000003 + number;
    CaseReport report{
        number, scanPair(edgesOf(world), world.poses.at(number), world.poses.at(number + 1), scan), {}, {}};
    vectorlib::CorrespondenceFinder find;
    find.settings = settings.search;
    report.result = find(report.scans.fixed.segments, report.scans.moving.segments);
    for (const vectorlib::Solution &solution : report.result.solutions)
        report.counts.push_back(report.scans.count(solution, settings.search.permitted));
    return report;
}

OverallReport reportOverall(const World &world, const ReportSettings &settings,
                            const std::function<void(std::size_t, std::size_t)> &progress) {
    OverallReport report;
    for (std::size_t i = 0; i + 1 < world.poses.size(); ++i) {
        report.cases.push_back(reportCase(world, i, settings));
        if (progress)
            progress(i + 1, world.poses.size() - 1);
    }
    return report;
}

int OverallReport::trueFirst() const {
    int count = 0;
    for (const CaseReport &c : cases)
        count += !c.result.solutions.empty() && c.scans.isTrue(c.result.solutions[0]);
    return count;
}

int OverallReport::trueAccepted() const {
    int count = 0;
    for (const CaseReport &c : cases)
        count += std::any_of(c.result.solutions.begin(), c.result.solutions.end(),
                             [&](const vectorlib::Solution &s) { return s.accepted && c.scans.isTrue(s); });
    return count;
}

int OverallReport::wrongAccepted() const {
    int count = 0;
    for (const CaseReport &c : cases)
        for (const vectorlib::Solution &s : c.result.solutions)
            count += s.accepted && !c.scans.isTrue(s);
    return count;
}

int OverallReport::falsePositives() const {
    int count = 0;
    for (const CaseReport &c : cases)
        count += c.counts.empty() ? 0 : c.counts[0].falsePositive;
    return count;
}

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

std::vector<Fact> datasetFacts(const World &world, const ReportSettings &settings) {
    return {{"Environment", world.name},
            {"Noise", text(100 * settings.scan.noise, 1, " cm")},
            {"Rays of a scan", std::to_string(settings.scan.rays)},
            {"Seed", std::to_string(settings.scan.seed)},
            {"Grid", "50 x 50 cm"}};
}

std::vector<Fact> observationFacts(const CaseReport &report) {
    const vectorlib::Transformation2D &truth = report.scans.truth;
    return {
        {"Scan points", "#" + std::to_string(report.number) + " to #" + std::to_string(report.number + 1)},
        {"True dx", text(100 * truth.x(), 0, " cm")},
        {"True dy", text(100 * truth.y(), 0, " cm")},
        {"True dalpha", text(truth.alpha(), 2, " rad")}};
}

std::vector<Fact> settingsFacts(const ReportSettings &settings) {
    const vectorlib::SearchSettings &s = settings.search;
    return {{"Maximal |dx|", text(100 * s.permitted.dx, 0, " cm")},
            {"Maximal |dy|", text(100 * s.permitted.dy, 0, " cm")},
            {"Maximal |dalpha|", text(s.permitted.dalpha, 2, " rad")},
            {"Vectorization error", text(100 * settings.scan.sigma, 1, " cm")},
            {"Reliability threshold", text(s.reliability, 2)},
            {"Ambiguity threshold, a pair", text(1e4 * s.ambiguity, 1, " cm2")},
            {"Ambiguity k alpha", text(1e4 * s.stiffness.alpha, 0, " cm2/rad2")},
            {"Ambiguity k xy", text(s.stiffness.xy, 1)},
            {"Discrepancy threshold",
             text(1e4 * s.discrepancy, 0, " cm2") + " or " + text(100 * s.discrepancyShare, 0, " %")}};
}

std::vector<Fact> solutionFacts(const vectorlib::Solution &solution) {
    return {{"Reliability", text(solution.reliability, 3)},
            {"Ambiguity", text(1e4 * solution.ambiguity, 2, " cm2")},
            {"Discrepancy", text(1e4 * solution.view.discrepancy, 0, " cm2")},
            {"Matched", text(100 * solution.matchedShare, 0, " %")},
            {"Score", text(solution.score, 3)}};
}

std::vector<Fact> countFacts(const PairCounts &counts) {
    return {{"True positive", std::to_string(counts.truePositive)},
            {"True negative", std::to_string(counts.trueNegative)},
            {"False positive", std::to_string(counts.falsePositive)},
            {"False negative", std::to_string(counts.falseNegative)}};
}

void forEachAccepted(const OverallReport &report,
                     const std::function<void(const std::vector<std::string> &cells)> &take) {
    for (const CaseReport &c : report.cases) {
        const std::string scans = "#" + std::to_string(c.number) + " to #" + std::to_string(c.number + 1);
        bool any = false;
        for (std::size_t i = 0; i < c.result.solutions.size(); ++i) {
            const vectorlib::Solution &s = c.result.solutions[i];
            if (!s.accepted)
                continue;
            std::vector<std::string> cells = {scans, std::to_string(i), text(s.reliability, 3),
                                              text(1e4 * s.ambiguity, 2), text(1e4 * s.view.discrepancy, 0)};
            for (const Fact &fact : countFacts(c.counts[i]))
                cells.push_back(fact.value);
            take(cells);
            any = true;
        }
        if (!any)
            take({scans, "-", "-", "-", "-", "-", "-", "-", "-"});
    }
}

std::string summaryOf(const OverallReport &report) {
    return "True solution ranked first in " + std::to_string(report.trueFirst()) + " of " +
           std::to_string(report.cases.size()) + " cases and accepted in " +
           std::to_string(report.trueAccepted()) +
           "; wrong solutions accepted: " + std::to_string(report.wrongAccepted()) +
           "; wrong pairs in the first-ranked solutions: " + std::to_string(report.falsePositives()) + ".";
}

} // namespace hermes::vector
