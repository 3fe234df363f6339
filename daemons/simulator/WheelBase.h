#pragma once

#include "protocol/messages/Motion.h"

#include <array>

namespace hermes::simulator {

/// The wheels under a robot, in the order front left, front right, rear left, rear right. Three omni wheels
/// are front left, rear left and front right, and a robot with two wheels has those in front. One that steers
/// is driven behind, where its centre is.
struct WheelBase {
    enum class Kind { Mecanum, Differential, TwoWheels, Omni3, Omni4, Ackermann };

    Kind kind = Kind::Mecanum;
    double radius = 0.1;       ///< of a wheel; metres
    double halfBase = 0.25;    ///< centre to axle, or half of the way from axle to axle; metres
    double halfTrack = 0.25;   ///< centre to the middle of a wheel; metres
    double omniRadius = 0.2;   ///< the same of omni wheels; metres
    double omniAngle = 1.0472; ///< of the front left omni wheel, counter-clockwise from ahead; the others
                               ///< follow evenly
    int rearMotors = 1;        ///< of one that steers: the rear left wheel's, for both, or two
    double servoCentre = 0.5;  ///< its position straight ahead, 0 to 1
    double servoPerRadian = 1; ///< and how far it goes for a radian to the left

    /// How the body moves when the wheels turn so fast (rad/s, positive forward, of omni wheels
    /// counter-clockwise about the centre) without slip, and the steering servo is at this position. Least
    /// squares where they fight each other.
    Twist2D twistOf(const std::array<double, 4> &wheels, double servo = 0.5) const;
};

} // namespace hermes::simulator
