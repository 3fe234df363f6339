#include "vectorlib/experiments/KnownScan.h"

#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/observation/Observer.h"

#include <algorithm>
#include <cmath>

namespace hermes::experiments {

using Point = vectorlib::Vector2D<double>;

KnownScan::KnownScan(const World &world, const vectorlib::Pose2D &pose, int rays)
    : nominalRays_(std::size_t(std::max(0, rays))) {
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
        if (ray.edge < edges_.size())
            rays_.push_back(ray);
    }
    if (rays_.empty() || rays_.front().edge != rays_.back().edge)
        return;
    const auto other = std::find_if(rays_.rbegin(), rays_.rend(),
                                    [&](const Ray &ray) { return ray.edge != rays_.back().edge; });
    std::rotate(rays_.begin(), other.base() == rays_.begin() ? rays_.begin() : other.base(), rays_.end());
}

} // namespace hermes::experiments
