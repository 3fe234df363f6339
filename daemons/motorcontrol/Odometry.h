#pragma once

#include "daemons/motorcontrol/Wheels.h"

namespace hermes::motorcontrol {

/// How the uncertainty of the odometry grows: standard deviations that add up like a random walk.
struct OdometryNoise {
    double positionPerMetre = 0.02; ///< m after one metre, along and across
    double headingPerMetre = 0.01;  ///< rad after one metre
    double headingPerRadian = 0.03; ///< rad after one radian of turn
};

/// Where the robot is by its wheels alone. Starts at the origin.
class Odometry {
public:
    /// Row by row, of x, y (m) and theta (rad).
    using Covariance = std::array<double, 9>;

    void setNoise(const OdometryNoise &noise) { noise_ = noise; }

    /// Adds a motion with constant velocity: its displacement in the robot's frame at its begin, as the
    /// forward kinematics gives it for the wheels' turns (vx, vy in m, omega in rad). The arc is exact, the
    /// exponential of SE(2).
    void move(const Twist2D &displacement);
    /// The robot was moved by an unknown amount of about this standard deviation: pose stays, doubt grows.
    void doubt(double metres, double radians);
    /// Starts again from here, certain.
    void reset(const Pose2D &pose);

    const Pose2D &pose() const { return pose_; }
    const Covariance &covariance() const { return covariance_; }

private:
    Pose2D pose_;
    Covariance covariance_{};
    OdometryNoise noise_;
};

} // namespace hermes::motorcontrol
