#pragma once

#include "common/world/World.h"
#include "vectorlib/geometry/SegmentPair.h"

#include <random>
#include <vector>

namespace hermes::vector {

/// A scanner at a pose of a world of which every ray knows the edge that it meets: scans whose
/// correspondences are known for sure. A full turn.
class KnownScan {
public:
    KnownScan(const World &world, const vectorlib::Pose2D &pose, int rays);

    /// The segments of a scan whose ranges have Gaussian noise (standard deviation, metres), each with its
    /// edge as the static partner, in the frame of the true pose: a perfect registration is the identity. One
    /// total least squares line for every run of rays on one edge that has three points or more and is at
    /// least minLength long (metres). The weight is the length of the shorter of the two.
    std::vector<vectorlib::SegmentPair> pairs(double noise, double minLength, std::mt19937_64 &random) const;

private:
    struct Ray {
        vectorlib::Vector2D<double> direction;
        double range;
        std::size_t edge;
    };
    std::vector<vectorlib::LineSegment2D<double>> edges_; // in the sensor's frame
    std::vector<std::vector<Ray>> runs_;                  // of rays that meet the same edge
};

} // namespace hermes::vector
