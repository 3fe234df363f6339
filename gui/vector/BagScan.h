#pragma once

#include "protocol/ros/Messages.h"
#include "vectorlib/mapping/TimedScan.h"

#include <optional>
#include <string>

namespace hermes::vector {

/// What of a cloud of points is a scan of one plane.
struct CloudOptions {
    std::optional<int> laser; ///< the ring of this number; nothing: the one that looks nearest to the horizon
    double height = 0;        ///< of the slice through a cloud without rings, over the sensor; metres
};

/// Makes scans of one plane of the messages of scanners. Rays without a return are those of NaN, of infinity,
/// and those outside of the ranges that the message tells. Each gives why the message is none; empty: it is
/// read.
class BagScan {
public:
    static constexpr std::size_t mostRays = 100000;
    static constexpr double slice_m = 0.1; ///< half the height of a slice
    static constexpr double longestScan_s = 10;

    explicit BagScan(CloudOptions options = {})
        : options_(options) {}

    std::string read(const ros::LaserScan &message, vectorlib::TimedScan &scan) const;
    /// Of each ray its first echo that is a return.
    std::string read(const ros::MultiEchoLaserScan &message, vectorlib::TimedScan &scan) const;
    /// The points in the order of their angles.
    std::string read(const ros::PointCloud &message, vectorlib::TimedScan &scan);

private:
    CloudOptions options_;
    std::optional<int> ring_; ///< that was found to look nearest to the horizon
};

/// Of a scanner that hangs upside down: its points as one that stands sees them, still counter-clockwise.
void hangUpsideDown(vectorlib::TimedScan &scan);

} // namespace hermes::vector
