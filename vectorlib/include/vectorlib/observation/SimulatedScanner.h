#pragma once

#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/observation/Observer.h"

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

namespace vectorlib {

/// How an error is spread about 0, at the same standard deviation.
enum class NoiseShape {
    Gaussian,
    Even ///< all errors up to sqrt(3) standard deviations alike
};

/// A planar scanner in a world of segments: rays at even steps, noise of range and direction, outliers. A ray
/// is stopped by either side of an edge. The same seed gives the same scans. Owns its buffers.
template <typename Scalar = float>
class SimulatedScanner {
public:
    int rays = 720;              ///< over the field of view
    double fieldOfView = 2 * pi; ///< radians, half of it to each side of the heading
    double sigma = 0.01;         ///< standard deviation of the range; metres
    double angleSigma = 0;       ///< of the direction, which the points do not tell; radians
    NoiseShape noise = NoiseShape::Gaussian;
    double outliers = 0;    ///< share of rays, 0 to 1, that stop anywhere before the wall
    double minRange = 0.05; ///< metres; nearer walls give no point
    double maxRange = 100;  ///< metres; farther walls give no point

    explicit SimulatedScanner(std::uint64_t seed = 1)
        : random_(seed) {}

    /// The direction of a ray, counter-clockwise from the heading; radians. A full turn has no ray twice: the
    /// last is a step short of the first; a smaller field of view has a ray at each of its limits.
    double angle(int ray) const {
        const int steps = fieldOfView >= 2 * pi ? rays : std::max(1, rays - 1);
        return -fieldOfView / 2 + ray * fieldOfView / steps;
    }

    /// The points of one scan in the sensor's frame, counter-clockwise; rays without return are left out.
    /// Valid until the next call.
    const std::vector<Vector2D<Scalar>> &operator()(const std::vector<LineSegment2D<Scalar>> &world,
                                                    const Pose2D &pose) {
        const Transformation2D toSensor = Transformation2D(pose).inverse();
        edges_.clear();
        for (const LineSegment2D<Scalar> &edge : world)
            edges_.push_back({toSensor * Vector(edge.begin()), toSensor * Vector(edge.end())});
        points_.clear();
        for (int ray = 0; ray < rays; ++ray) {
            const double range =
                measure(directionOf(angleSigma > 0 ? angle(ray) + angleSigma * error() : angle(ray)));
            if (range >= minRange && range <= maxRange)
                points_.push_back(Vector2D<Scalar>(directionOf(angle(ray)) * range));
        }
        return points_;
    }

private:
    using Vector = Vector2D<double>;
    struct Edge {
        Vector begin;
        Vector end;
    };

    static Vector directionOf(double angle) { return {std::cos(angle), std::sin(angle)}; }

    // Of standard deviation 1.
    double error() {
        return noise == NoiseShape::Even ? std::sqrt(3.0) * (2 * uniform_(random_) - 1) : normal_(random_);
    }

    double measure(Vector direction) {
        double range = noHit;
        for (const Edge &edge : edges_)
            range = std::min(range, rayDistance(direction, edge.begin, edge.end));
        if (outliers > 0 && uniform_(random_) < outliers)
            return minRange + uniform_(random_) * std::max(0.0, std::min(range, maxRange) - minRange);
        return range + sigma * error();
    }

    std::mt19937_64 random_;
    std::normal_distribution<double> normal_;
    std::uniform_real_distribution<double> uniform_;
    std::vector<Edge> edges_;
    std::vector<Vector2D<Scalar>> points_;
};

} // namespace vectorlib
