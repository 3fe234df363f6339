#include "gui/vector/experiment/RelationScans.h"

#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/observation/Ray.h"

#include <algorithm>
#include <random>

namespace hermes::vector {

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

std::vector<PosedScan> scansAt(const World &world, const std::vector<Pose2D> &poses, std::uint64_t seed,
                               const HalfTurnScanner &scanner) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> even(-1, 1);
    std::vector<PosedScan> scans;
    std::vector<Segment> edges;
    constexpr double degree = vectorlib::pi / 180;
    for (const Pose2D &pose : poses) {
        const vectorlib::Transformation2D toSensor = vectorlib::Transformation2D(pose).inverse();
        edges.clear();
        for (const World::Edge &e : world.edges)
            edges.push_back(toSensor * Segment(Point(e.x1, e.y1), Point(e.x2, e.y2)));
        scans.push_back({{}, pose});
        for (int ray = 0; ray < HalfTurnScanner::rays; ++ray) {
            const double nominal = (ray - (HalfTurnScanner::rays - 1) / 2) * degree;
            const double real = nominal + scanner.directionNoise * degree * even(random);
            double range = vectorlib::noHit;
            for (const Segment &e : edges)
                range = std::min(
                    range, vectorlib::rayDistance({std::cos(real), std::sin(real)}, e.begin(), e.end()));
            range += scanner.rangeNoise * even(random);
            if (range > 0 && range < HalfTurnScanner::maxRange)
                scans.back().points.emplace_back(
                    vectorlib::Vector2D<double>(std::cos(nominal) * range, std::sin(nominal) * range));
        }
    }
    return scans;
}

} // namespace hermes::vector
