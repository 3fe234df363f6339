#pragma once

#include "vectorlib/geometry/Transformation2D.h"

#include <limits>
#include <optional>
#include <vector>

namespace vectorlib {

/// A line `ODOM x y theta tv rv accel ipc_timestamp host logger_timestamp`; metres, radians, seconds.
struct CarmenOdometry {
    std::size_t line = 0;
    double stamp = 0;
    Pose2D pose;
};

/// A line FLASER or ROBOTLASER1: one scan, counter-clockwise; metres, radians, seconds.
struct CarmenScan {
    std::size_t line = 0;
    double stamp = 0;
    double startAngle = 0; ///< of the first ray, in the sensor's frame
    double angleStep = 0;
    /// Ranges from here on mean no return. FLASER does not say it: CarmenLog::guessMaxRange fills it in.
    double maxRange = std::numeric_limits<double>::infinity();
    std::vector<float> ranges; ///< every ray, also those without return
    Pose2D laserPose;          ///< first triple; the reference pose in corrected logs
    Pose2D robotPose;          ///< second triple; the odometry in ordinary logs
    /// Motion since the previous scan by the ODOM lines between them, begun at the previous scan's pose as
    /// corrected logs write it. Never holds this scan's own pose. Nothing when no ODOM line stands between
    /// that says more than the scan itself.
    std::optional<Transformation2D> wheelMotion;
    bool hasOdometry = true; ///< robotPose is a pose; else it was refused (CarmenOptions::refusesOdometry)

    /// Whether a ray met something: its range is above 0 and less than maxRange.
    bool isReturn(std::size_t ray) const { return ranges[ray] > 0 && ranges[ray] < maxRange; }
    /// Appends the points of the rays with return, in the sensor's frame and in ray order.
    template <typename Scalar>
    void appendPoints(std::vector<Vector2D<Scalar>> &points) const {
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            if (!isReturn(i))
                continue;
            const double angle = startAngle + angleStep * static_cast<double>(i);
            points.emplace_back(Scalar(ranges[i] * std::cos(angle)), Scalar(ranges[i] * std::sin(angle)));
        }
    }
};

} // namespace vectorlib
