#pragma once

#include "daemons/motorcontrol/WheelLayout.h"

namespace hermes::motorcontrol {

/// What the robot may do, each component for itself, both ways.
struct MotionLimits {
    Twist2D velocity{1, 1, 1.5};   ///< m/s, m/s, rad/s
    Twist2D acceleration{1, 1, 3}; ///< m/s^2, m/s^2, rad/s^2
    double wheelSpeed = 20;        ///< rad/s, what every motor can reach
};

/// All speeds divided by one number, so that none is over the limit and the direction of the motion stays.
WheelValues saturated(const WheelValues &speeds, double wheelSpeed);

/// The speeds after dt seconds on the straight way from current to target within the limits of acceleration.
/// All wheels arrive together. What the wheels do beyond the motion of a rigid robot is held to the largest
/// acceleration that a wheel has in any motion within the limits.
WheelValues ramped(const WheelValues &current, const WheelValues &target, const WheelLayout &layout,
                   const Twist2D &acceleration, double dt);

} // namespace hermes::motorcontrol
