#pragma once

#include "common/world/World.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"

#include <vector>

namespace hermes::experiments {

/// A scanner at a pose of a world of which every ray knows the edge that it meets: scans whose
/// correspondences are known for sure. A full turn.
class KnownScan {
public:
    struct Ray {
        vectorlib::Vector2D<double> direction;
        double range;     ///< without noise; metres
        std::size_t edge; ///< index into edges()
    };

    KnownScan(const World &world, const vectorlib::Pose2D &pose, int rays);

    /// The edges of the world in the frame of the pose.
    const std::vector<vectorlib::LineSegment2D<double>> &edges() const { return edges_; }
    /// The rays that meet an edge, counter-clockwise; neighbours that meet the same edge are never parted by
    /// the begin of the list.
    const std::vector<Ray> &rays() const { return rays_; }

    /// Rays of the scanner, with those that meet nothing.
    std::size_t nominalRays() const { return nominalRays_; }

private:
    std::size_t nominalRays_;
    std::vector<vectorlib::LineSegment2D<double>> edges_;
    std::vector<Ray> rays_;
};

} // namespace hermes::experiments
