#pragma once

#include "tests/bench/ScanPair.h"
#include <vectorlib/observation/FloorPlan.h>

#include <vectorlib/observation/SimulatedScanner.h>

namespace bench {

/// Pairs of scans in floor plans at random: a full turn of 720 rays with 1 cm of noise, from two places up to
/// 1.5 m apart with no wall between them, any two headings. The same seed gives the same pairs.
class FloorPlanPairs {
public:
    explicit FloorPlanPairs(unsigned seed)
        : seed_(seed)
        , scan_(seed) {}

    ScanPairs draw(std::size_t count) {
        ScanPairs pairs;
        for (std::size_t i = 0; i < count; ++i) {
            vectorlib::FloorPlan plan(seed_ + unsigned(i), 6);
            const vectorlib::Pose2D from = plan.place(), to = placeBeside(from, plan);
            pairs.push_back(pairOf(plan, from, to));
        }
        return pairs;
    }

private:
    using Point = vectorlib::Vector2D<double>;

    static vectorlib::Pose2D placeBeside(const vectorlib::Pose2D &from, vectorlib::FloorPlan &plan) {
        for (;;) {
            const vectorlib::Pose2D to = plan.place();
            const Point start(from.x, from.y), way = Point(to.x, to.y) - start;
            const bool isHidden =
                std::any_of(plan.walls().begin(), plan.walls().end(), [&](const auto &wall) {
                    return vectorlib::rayDistance(way.normalized(), wall.begin() - start,
                                                  wall.end() - start) < way.norm();
                });
            if (way.norm() <= 1.5 && !isHidden)
                return to;
        }
    }
    ScanPair pairOf(const vectorlib::FloorPlan &plan, const vectorlib::Pose2D &from,
                    const vectorlib::Pose2D &to) {
        world_.clear();
        for (const auto &wall : plan.walls())
            world_.emplace_back(wall);
        ScanPair p;
        p.fixed = scan_(world_, from);
        p.moving = scan_(world_, to);
        p.reference = vectorlib::Transformation2D(from).inverse() * vectorlib::Transformation2D(to);
        p.fieldOfView = scan_.fieldOfView;
        p.rays = std::size_t(scan_.rays);
        return p;
    }

    unsigned seed_;
    vectorlib::SimulatedScanner<float> scan_;
    std::vector<vectorlib::LineSegment2D<float>> world_;
};

} // namespace bench
