#include "vectorlib/experiments/OverviewExperiment.h"

#include "vectorlib/correspondence/QuadrangleMatcher.h"
#include "vectorlib/experiments/report/ScanPair.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/io/Svg.h"
#include "vectorlib/mapping/MapBuilder.h"
#include "vectorlib/observation/SimulatedScanner.h"

#include <algorithm>
#include <random>

namespace hermes::experiments {

using vectorlib::Pose2D;
using vectorlib::SvgPicture;
using vectorlib::Transformation2D;
using Point = vectorlib::Vector2D<double>;
using Points = std::vector<vectorlib::Vector2D<float>>;

namespace {

double apart(const Pose2D &a, const Pose2D &b) {
    return std::hypot(b.x - a.x, b.y - a.y);
}

double turnBetween(const Pose2D &a, const Pose2D &b) {
    return std::abs((Transformation2D(a).inverse() * Transformation2D(b)).alpha());
}

/// The motion as a bad odometry tells it.
Transformation2D told(const Transformation2D &motion, const OdometryErrors &errors, std::mt19937_64 &random) {
    std::normal_distribution<double> normal;
    const double x = motion.x() * (1 + errors.scale) + errors.deviationXY * normal(random);
    const double y = motion.y() * (1 + errors.scale) + errors.deviationXY * normal(random);
    return {x, y, motion.alpha() + errors.turn + errors.deviationAlpha * normal(random)};
}

void takeScans(const World &world, std::uint64_t seed, std::vector<OverviewScan> &scans) {
    vectorlib::SimulatedScanner<float> scanner(seed);
    scanner.rays = 2000;
    scanner.sigma = 0.02;
    scanner.outliers = 0.01;
    std::vector<vectorlib::LineSegment2D<float>> walls;
    for (const vectorlib::LineSegment2D<double> &wall : edgesOf(world))
        walls.emplace_back(wall);
    for (const Pose2D &pose : world.poses) {
        scans.emplace_back();
        scans.back().truth = pose;
        scans.back().points = scanner(walls, pose);
    }
}

std::vector<vectorlib::LineSegment2D<double>> segmentsOf(const vectorlib::VectorMap &map) {
    std::vector<vectorlib::LineSegment2D<double>> segments;
    map.forEach([&](const vectorlib::MapEdge &edge) { segments.push_back(edge.segment); });
    return segments;
}

/// Finds the pose in the map and adds the edges there: paper 2.2 and 2.3.
void processAsPublished(vectorlib::MapBuilder &builder, vectorlib::QuadrangleMatcher &match,
                        OverviewScan &scan, const Pose2D &expected) {
    const std::vector<vectorlib::EdgeRaw2D> edges = builder.extract(scan.points);
    std::vector<vectorlib::LineSegment2D<double>> seen;
    for (const vectorlib::EdgeRaw2D &edge : edges)
        seen.push_back(edge.segment);
    const bool isFirst = builder.map.isEmpty();
    const vectorlib::QuadrangleMatch &found =
        match(segmentsOf(builder.map), seen, Transformation2D(expected));
    scan.found = isFirst ? expected : found.pose.pose();
    scan.isMatched = isFirst || found.accepted;
    builder.place(edges, scan.found);
}

/// The first, the least, the median and the largest of the closing errors.
nlohmann::ordered_json closingErrors(const std::vector<OverviewRun> &runs) {
    std::vector<double> closing;
    std::size_t lost = 0;
    double worst = 0;
    for (const OverviewRun &run : runs) {
        closing.push_back(run.closingError());
        for (const OverviewScan &scan : run.scans) {
            lost += !scan.isMatched;
            worst = std::max(worst, apart(scan.truth, scan.found));
        }
    }
    std::sort(closing.begin(), closing.end());
    return {{"first_run", runs.front().closingError()},
            {"least", closing.front()},
            {"median", closing[closing.size() / 2]},
            {"largest", closing.back()},
            {"largest_on_the_way", worst},
            {"lost", lost}};
}

std::vector<Point> wayOf(const OverviewRun &run, Pose2D OverviewScan::*which) {
    std::vector<Point> way;
    for (const OverviewScan &scan : run.scans)
        way.emplace_back((scan.*which).x, (scan.*which).y);
    return way;
}

} // namespace

double OverviewRun::length() const {
    double length = 0;
    for (std::size_t i = 1; i < scans.size(); ++i)
        length += apart(scans[i - 1].truth, scans[i].truth);
    return length;
}

double OverviewRun::closingError() const {
    return scans.empty() ? 0 : apart(scans.back().truth, scans.back().found);
}

double OverviewRun::odometryClosingError() const {
    return scans.empty() ? 0 : apart(scans.back().truth, scans.back().odometry);
}

OverviewRun overviewRun(const World &world, const OdometryErrors &errors, std::uint64_t seed,
                        OverviewMatcher matcher) {
    OverviewRun run;
    run.seed = seed;
    takeScans(world, seed, run.scans);
    std::mt19937_64 random(seed);
    vectorlib::MapBuilder builder;
    vectorlib::QuadrangleMatcher quadrangle;
    quadrangle.select.settings.minLength = longEdge;
    for (std::size_t i = 0; i < run.scans.size(); ++i) {
        OverviewScan &scan = run.scans[i];
        Pose2D expected = scan.odometry = scan.truth; // the first defines the frame
        if (i > 0) {
            const OverviewScan &last = run.scans[i - 1];
            const Transformation2D motion =
                told(Transformation2D(last.truth).inverse() * Transformation2D(scan.truth), errors, random);
            scan.odometry = (Transformation2D(last.odometry) * motion).pose();
            expected = (Transformation2D(last.found) * motion).pose();
        }
        if (matcher == OverviewMatcher::Quadrangle) {
            processAsPublished(builder, quadrangle, scan, expected);
            continue;
        }
        const vectorlib::ScanReport &report = builder.process(scan.points, expected);
        scan.found = report.pose;
        scan.isMatched = report.outcome == vectorlib::ScanReport::Outcome::Matched;
    }
    run.edges = segmentsOf(builder.map);
    return run;
}

void writeCsv(std::ostream &out, const std::vector<OverviewRun> &runs) {
    using vectorlib::Number;
    out << "seed,scan,x,y,theta,odometry_x,odometry_y,odometry_theta,found_x,found_y,found_theta,matched,"
           "odometry_error_m,odometry_error_deg,error_m,error_deg\n";
    constexpr double degrees = 180 / vectorlib::pi;
    for (const OverviewRun &run : runs)
        for (std::size_t i = 0; i < run.scans.size(); ++i) {
            const OverviewScan &s = run.scans[i];
            out << run.seed << ',' << i;
            for (const Pose2D &pose : {s.truth, s.odometry, s.found})
                out << ',' << Number(pose.x) << ',' << Number(pose.y) << ',' << Number(pose.theta);
            out << ',' << s.isMatched;
            for (const Pose2D &pose : {s.odometry, s.found})
                out << ',' << Number(apart(s.truth, pose)) << ','
                    << Number(degrees * turnBetween(s.truth, pose));
            out << '\n';
        }
}

nlohmann::ordered_json summaryOf(const std::vector<OverviewRun> &runs, const std::vector<OverviewRun> &older,
                                 const nlohmann::ordered_json &published) {
    if (runs.empty() || older.empty())
        return {{"runs", 0}};
    const OverviewRun &first = runs.front();
    const auto longEdges = std::size_t(std::count_if(
        first.edges.begin(), first.edges.end(), [](const auto &edge) { return edge.length() >= longEdge; }));
    return {{"scans", first.scans.size()},
            {"length_m", first.length()},
            {"runs", runs.size()},
            {"long_edges", longEdges},
            {"short_edges", first.edges.size() - longEdges},
            {"odometry_closing_error_m", first.odometryClosingError()},
            {"closing_error_m", closingErrors(runs)},
            {"closing_error_m_of_the_older_matcher", closingErrors(older)},
            {"published", published}};
}

// Of a picture: with more of them pdflatex runs out of memory.
constexpr std::size_t maxPoints = 25000;

vectorlib::SvgPicture pictureOfRaw(const std::string &title, const OverviewRun &run) {
    SvgPicture picture(title);
    std::size_t count = 0;
    for (const OverviewScan &scan : run.scans)
        count += scan.points.size();
    const std::size_t each = 1 + count / maxPoints;
    Points shown;
    for (const OverviewScan &scan : run.scans)
        for (std::size_t i = 0; i < scan.points.size(); i += each)
            shown.push_back(Transformation2D(scan.odometry) * scan.points[i]);
    picture.points({vectorlib::colour::reference, 1.5,
                    (each == 1 ? "" : "1 of " + std::to_string(each) + " ") +
                        std::string("points of all scans, as the odometry puts them")},
                   shown);
    picture.path({vectorlib::colour::distinct(2), 2.5, "odometry"}, wayOf(run, &OverviewScan::odometry));
    for (const OverviewScan &scan : run.scans)
        picture.pose({vectorlib::colour::distinct(2), 2, ""}, {scan.odometry.x, scan.odometry.y},
                     scan.odometry.theta);
    return picture;
}

vectorlib::SvgPicture pictureOfScan(const std::string &title, const OverviewScan &scan) {
    SvgPicture picture(title);
    vectorlib::EdgeExtractor extract;
    const auto ordered = extract.order(scan.points);
    const vectorlib::Segmentation &clusters = extract.segment(ordered);
    for (std::size_t c = 0; c < clusters.size(); ++c) {
        Points cluster;
        for (std::size_t i = clusters.starts[c]; i < clusters.starts[c + 1]; ++i)
            cluster.push_back(ordered[static_cast<std::size_t>(clusters.order[i])]);
        picture.points({vectorlib::colour::distinct(c), 3, c == 0 ? "clusters" : ""}, cluster);
    }
    std::vector<vectorlib::LineSegment2D<double>> lines;
    for (const vectorlib::EdgeRaw2D &edge : extract.vectorizeClusters(clusters, ordered))
        lines.push_back(edge.segment);
    picture.segments({vectorlib::colour::map, 1.5, "lines"}, lines);
    picture.pose({vectorlib::colour::map, 2, "scanner"}, {0, 0}, 0);
    return picture;
}

vectorlib::SvgPicture pictureOfMap(const std::string &title, const OverviewRun &run) {
    SvgPicture picture(title);
    std::vector<vectorlib::LineSegment2D<double>> lengthy, brief;
    for (const auto &edge : run.edges)
        (edge.length() >= longEdge ? lengthy : brief).push_back(edge);
    picture.segments({vectorlib::colour::outliers, 2, "edges of 0.5 m and more"}, lengthy);
    picture.segments({vectorlib::colour::distinct(4), 2, "shorter edges"}, brief);
    picture.path({vectorlib::colour::distinct(2), 1.5, "odometry"}, wayOf(run, &OverviewScan::odometry));
    picture.path({vectorlib::colour::map, 2, "corrected way"}, wayOf(run, &OverviewScan::found));
    for (const OverviewScan &scan : run.scans)
        picture.pose({vectorlib::colour::map, 1, ""}, {scan.found.x, scan.found.y}, scan.found.theta);
    return picture;
}

} // namespace hermes::experiments
