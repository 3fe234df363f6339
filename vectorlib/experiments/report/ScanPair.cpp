#include "vectorlib/experiments/report/ScanPair.h"

#include "vectorlib/edges/EdgeExtractor.h"
#include "vectorlib/observation/SimulatedScanner.h"

namespace hermes::experiments {

using Point = vectorlib::Vector2D<double>;
using Segment = vectorlib::LineSegment2D<double>;

namespace {

constexpr double besideEdge = 0.15; // metres; farther segments show another edge or none
constexpr double alongEdge = 0.20;  // radians

/// Whether the segment shows the edge: they run beside each other over half of the shorter.
bool shows(const Segment &segment, const Segment &edge) {
    const double turn =
        std::atan2(segment.direction().cross(edge.direction()), segment.direction().dot(edge.direction()));
    if (std::abs(turn) > alongEdge)
        return false;
    const double from = std::clamp(segment.along(edge.begin()), 0.0, segment.length());
    const double to = std::clamp(segment.along(edge.end()), 0.0, segment.length());
    const Point middle = segment.begin() + segment.direction() * ((from + to) / 2);
    return std::abs(edge.across(middle)) <= besideEdge &&
           to - from >= 0.5 * std::min(segment.length(), edge.length());
}

std::vector<int> edgesShownBy(const Segment &segment, const Segments &world) {
    std::vector<int> shown;
    for (std::size_t i = 0; i < world.size(); ++i)
        if (shows(segment, world[i]))
            shown.push_back(static_cast<int>(i));
    return shown;
}

bool haveCommon(const std::vector<int> &a, const std::vector<int> &b) {
    return std::any_of(a.begin(), a.end(),
                       [&](int i) { return std::find(b.begin(), b.end(), i) != b.end(); });
}

} // namespace

Segments edgesOf(const World &world) {
    Segments edges;
    for (const World::Edge &e : world.edges)
        edges.emplace_back(Point(e.x1, e.y1), Point(e.x2, e.y2));
    return edges;
}

VectorScan scanWorld(const Segments &world, const vectorlib::Pose2D &pose, const ScanSettings &settings) {
    vectorlib::SimulatedScanner<double> scanner(settings.seed);
    scanner.rays = settings.rays;
    scanner.sigma = settings.noise;
    VectorScan scan;
    for (const Point &p : scanner(world, pose))
        scan.points.emplace_back(p);
    vectorlib::EdgeExtractor extract;
    extract.segment.settings.nominalPoints = static_cast<std::size_t>(settings.rays);
    extract.vectorize.settings.sigma = settings.sigma;
    const vectorlib::Transformation2D toWorld(pose);
    for (const vectorlib::EdgeRaw2D &edge : extract(vectorlib::PointSpan<float>(scan.points))) {
        scan.segments.push_back(edge.segment);
        scan.edges.push_back(edgesShownBy(toWorld * edge.segment, world));
    }
    return scan;
}

ScanPair scanPair(const Segments &world, const vectorlib::Pose2D &first, const vectorlib::Pose2D &second,
                  const ScanSettings &settings) {
    ScanSettings other = settings;
    other.seed = settings.seed + 0x9e3779b97f4a7c15u; // noise of its own
    return {scanWorld(world, first, settings), scanWorld(world, second, other),
            vectorlib::Transformation2D(first).inverse() * vectorlib::Transformation2D(second)};
}

PairCounts ScanPair::count(const vectorlib::Solution &solution,
                           const vectorlib::PermittedError &permitted) const {
    PairCounts counts;
    for (std::size_t m = 0; m < moving.segments.size(); ++m)
        for (std::size_t f = 0; f < fixed.segments.size(); ++f) {
            const Segment &onto = fixed.segments[f], moved = truth * moving.segments[m];
            if (!vectorlib::mayCorrespond(onto, moving.segments[m], permitted))
                continue;
            const bool isTrue = haveCommon(fixed.edges[f], moving.edges[m]) && onto.overlap(moved) > 0;
            bool chosen = false;
            for (const vectorlib::CorrespondencePair &p : solution.pairs)
                chosen = chosen || (p.fixed == static_cast<int>(f) && p.moving == static_cast<int>(m));
            ++(isTrue   ? chosen ? counts.truePositive : counts.falseNegative
               : chosen ? counts.falsePositive
                        : counts.trueNegative);
        }
    return counts;
}

bool ScanPair::isTrue(const vectorlib::Solution &solution) const {
    const vectorlib::Transformation2D error = truth.inverse() * solution.pose;
    return error.translation().norm() <= 0.10 && std::abs(error.alpha()) <= 2 * vectorlib::pi / 180;
}

} // namespace hermes::experiments
