#include "vectorlib/experiments/RelationScans.h"

#include "vectorlib/geometry/Transformation2D.h"

#include <algorithm>
#include <cmath>

namespace hermes::experiments {

using vectorlib::Pose2D;
using Point = vectorlib::Vector2D<double>;
using Segment = vectorlib::LineSegment2D<double>;

namespace {

/// The pose at t, 0 to 1, between two poses: a Hermite curve whose tangents are as long as those of an arc;
/// of poses in one place a turn.
Pose2D between(const Pose2D &from, const Pose2D &to, double t) {
    const Point a(from.x, from.y), b(to.x, to.y);
    const double turn = vectorlib::wrapAngle(to.theta - from.theta), half = std::cos(turn / 4);
    const double reach = (b - a).norm() / (half * half);
    const Point u = Point(std::cos(from.theta), std::sin(from.theta)) * reach;
    const Point v = Point(std::cos(to.theta), std::sin(to.theta)) * reach;
    const double t2 = t * t, t3 = t2 * t;
    const Point p = a * (2 * t3 - 3 * t2 + 1) + u * (t3 - 2 * t2 + t) + b * (3 * t2 - 2 * t3) + v * (t3 - t2);
    const Point d =
        a * (6 * t2 - 6 * t) + u * (3 * t2 - 4 * t + 1) + b * (6 * t - 6 * t2) + v * (3 * t2 - 2 * t);
    return {p.x, p.y, reach > 0 ? std::atan2(d.y, d.x) : vectorlib::wrapAngle(from.theta + t * turn)};
}

double apart(const Pose2D &a, const Pose2D &b) {
    return std::hypot(b.x - a.x, b.y - a.y);
}

} // namespace

std::vector<Pose2D> posesAlong(const World &world, std::size_t count) {
    constexpr int parts = 400; // of the way between two poses
    std::vector<Pose2D> fine;
    for (std::size_t i = 0; i + 1 < world.poses.size(); ++i)
        for (int k = fine.empty() ? 0 : 1; k <= parts; ++k)
            fine.push_back(between(world.poses[i], world.poses[i + 1], double(k) / parts));
    std::vector<Pose2D> poses;
    if (fine.size() < 2 || count < 2)
        return fine;
    const double step = lengthOf(fine) / double(count - 1);
    double gone = 0; // up to fine[at]
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i) {
        double here = apart(fine[at], fine[at + 1]);
        while (at + 2 < fine.size() && gone + here < step * double(i)) {
            gone += here;
            ++at;
            here = apart(fine[at], fine[at + 1]);
        }
        const Pose2D &a = fine[at], &b = fine[at + 1];
        const double f = here > 0 ? std::clamp((step * double(i) - gone) / here, 0.0, 1.0) : 0;
        poses.push_back({a.x + f * (b.x - a.x), a.y + f * (b.y - a.y),
                         vectorlib::wrapAngle(a.theta + f * vectorlib::wrapAngle(b.theta - a.theta))});
    }
    return poses;
}

double lengthOf(const std::vector<Pose2D> &poses) {
    double length = 0;
    for (std::size_t i = 1; i < poses.size(); ++i)
        length += apart(poses[i - 1], poses[i]);
    return length;
}

vectorlib::SimulatedScanner<double> halfTurnScanner(std::uint64_t seed) {
    const double ofEven = 1 / std::sqrt(3.0); // the standard deviation of what is spread evenly up to 1
    vectorlib::SimulatedScanner<double> scanner(seed);
    scanner.rays = halfTurnRays;
    scanner.fieldOfView = vectorlib::pi;
    scanner.noise = vectorlib::NoiseShape::Even;
    scanner.sigma = 0.025 * ofEven;
    scanner.angleSigma = 0.1 * vectorlib::pi / 180 * ofEven;
    scanner.minRange = 0;
    scanner.maxRange = 30;
    return scanner;
}

std::vector<PosedScan> scansAt(const World &world, const std::vector<Pose2D> &poses,
                               vectorlib::SimulatedScanner<double> scanner) {
    std::vector<Segment> edges;
    for (const World::Edge &e : world.edges)
        edges.emplace_back(Point(e.x1, e.y1), Point(e.x2, e.y2));
    std::vector<PosedScan> scans;
    for (const Pose2D &pose : poses) {
        scans.push_back({{}, pose});
        for (const Point &point : scanner(edges, pose))
            scans.back().points.emplace_back(point);
    }
    return scans;
}

} // namespace hermes::experiments
