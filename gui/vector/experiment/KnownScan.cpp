#include "gui/vector/experiment/KnownScan.h"

#include "vectorlib/observation/Ray.h"
#include "vectorlib/vectorization/VectorizedLine.h"

namespace hermes::vector {

using Point = vectorlib::Vector2D<double>;

KnownScan::KnownScan(const World &world, const vectorlib::Pose2D &pose, int rays) {
    const vectorlib::Transformation2D toSensor =
        vectorlib::Transformation2D(pose.x, pose.y, pose.theta).inverse();
    for (const World::Edge &e : world.edges)
        edges_.emplace_back(toSensor * Point(e.x1, e.y1), toSensor * Point(e.x2, e.y2));
    for (int i = 0; i < rays; ++i) {
        const double angle = 2 * vectorlib::pi * i / rays;
        Ray ray{{std::cos(angle), std::sin(angle)}, vectorlib::noHit, edges_.size()};
        for (std::size_t e = 0; e < edges_.size(); ++e)
            if (const double range =
                    vectorlib::rayDistance(ray.direction, edges_[e].begin(), edges_[e].end());
                range < ray.range) {
                ray.range = range;
                ray.edge = e;
            }
        if (ray.edge == edges_.size())
            continue;
        if (runs_.empty() || runs_.back().back().edge != ray.edge)
            runs_.emplace_back();
        runs_.back().push_back(ray);
    }
    if (runs_.size() > 1 && runs_.front().front().edge == runs_.back().back().edge) { // a full turn
        runs_.back().insert(runs_.back().end(), runs_.front().begin(), runs_.front().end());
        runs_.erase(runs_.begin());
    }
}

std::vector<vectorlib::SegmentPair> KnownScan::pairs(double noise, double minLength,
                                                     std::mt19937_64 &random) const {
    constexpr std::size_t fewest = 3; // two points fit any line
    std::normal_distribution<double> normal;
    std::vector<vectorlib::SegmentPair> pairs;
    std::vector<Point> points;
    for (const std::vector<Ray> &run : runs_) {
        points.clear();
        for (const Ray &ray : run)
            points.push_back(ray.direction * (ray.range + noise * normal(random)));
        if (points.size() < fewest)
            continue;
        const vectorlib::TlsSums sums = vectorlib::TlsSums::of(points.begin(), points.end());
        const vectorlib::LineSegment2D<double>
            &fixed = edges_[run.front().edge],
            seen =
                vectorlib::makeLine(vectorlib::PointSpan<double>(points), 0, points.size() - 1, sums).segment;
        if (seen.length() > 0 && seen.length() >= minLength)
            pairs.push_back({fixed, seen, std::min(fixed.length(), seen.length())});
    }
    return pairs;
}

} // namespace hermes::vector
