#pragma once

#include "protocol/messages/Motion.h"

#include <cmath>

namespace hermes::desktop {

/// No place on Earth is farther from the origin of a map (m).
constexpr double farthest_m = 1e6;

/// Metres, radians, or either a second; NaN is not plausible.
inline bool isPlausible(double value) {
    return std::abs(value) <= farthest_m;
}
inline bool isPlausible(const Pose2D &pose) {
    return isPlausible(pose.x) && isPlausible(pose.y) && isPlausible(pose.theta);
}
inline bool isPlausible(const Twist2D &twist) {
    return isPlausible(twist.vx) && isPlausible(twist.vy) && isPlausible(twist.omega);
}

} // namespace hermes::desktop
