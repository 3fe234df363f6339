#pragma once

#include "common/Result.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/mapping/MotionModel.h"

#include <Eigen/Core>
#include <QJsonObject>

namespace hermes {

/// Where the robot is at one time, by its odometry.
struct OdometrySample {
    double stamp = 0;                                     ///< seconds since the Unix epoch
    vectorlib::Pose2D pose;                               ///< of the robot in the odometry's frame
    vectorlib::Twist2D twist;                             ///< robot frame
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero(); ///< of the pose; m^2, m rad, rad^2
};

/// Reads the data of an `odometry` message: {pose: {x, y, theta}, twist: {vx, vy, omega}, covariance: 9
/// numbers}; other members are left alone. The error says which member is wrong, what was found and what was
/// expected.
Result<OdometrySample> parseOdometry(const QJsonObject &data, double stamp);

} // namespace hermes
