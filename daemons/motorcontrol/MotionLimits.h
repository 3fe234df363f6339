#pragma once

#include "daemons/motorcontrol/WheelLayout.h"

namespace hermes::motorcontrol {

/// What the robot may do, each component for itself, both ways.
struct MotionLimits {
    Twist2D velocity{1, 1, 1.5};   ///< m/s, m/s, rad/s
    Twist2D acceleration{1, 1, 3}; ///< m/s^2, m/s^2, rad/s^2
    double wheelSpeed = 20;        ///< rad/s, what every motor can reach
    double steeringRate = 1;       ///< rad/s, of a steered axle
};

/// How a robot that steers goes.
struct Bend {
    double speed = 0;    ///< m/s, forward
    double steering = 0; ///< rad, to the left
};

/// All speeds divided by one number, so that none is over the limit and the direction of the motion stays.
WheelValues saturated(const WheelValues &speeds, double wheelSpeed);

/// The speeds after dt seconds on the straight way from current to target within the limits of acceleration.
/// All wheels arrive together. What the wheels do beyond the motion of a rigid robot is held to the largest
/// acceleration that a wheel has in any motion within the limits.
WheelValues ramped(const WheelValues &current, const WheelValues &target, const WheelLayout &layout,
                   const Twist2D &acceleration, double dt);

/// The same of a robot that steers. Speed and steering each take the time that they need, but neither goes
/// ahead where the robot would turn faster, or faster and faster, than it may: slowing down and straightening
/// come first.
Bend bent(const Bend &current, const Bend &target, const WheelLayout &layout, const MotionLimits &limits,
          double dt);

} // namespace hermes::motorcontrol
