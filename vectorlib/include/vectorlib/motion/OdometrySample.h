#pragma once

#include "vectorlib/geometry/Twist2D.h"

#include <Eigen/Core>

#include <optional>

namespace vectorlib {

/// Where the robot is at one time, by its odometry.
struct OdometrySample {
    double stamp = 0; ///< seconds since the Unix epoch
    Pose2D pose;      ///< of the robot in the odometry's frame
    Twist2D twist;    ///< robot frame
    /// Of the pose, since the odometry began; m^2, m rad, rad^2. Nothing where the odometry does not tell.
    std::optional<Eigen::Matrix3d> covariance;
};

} // namespace vectorlib
