#pragma once

#include "vectorlib/geometry/Angle.h"

namespace vectorlib {

/// Position (metres) and heading (radians, counter-clockwise from the x axis) in a given frame. As a motion:
/// the pose after it, in the frame of the pose before. Transformation2D is the form for moving many points.
struct Pose2D {
    double x = 0;
    double y = 0;
    double theta = 0;

    /// A pose in the frame of this one, in the frame that this one is given in; heading in (-pi, pi].
    Pose2D operator*(const Pose2D &inner) const {
        const double c = std::cos(theta), s = std::sin(theta);
        return {x + c * inner.x - s * inner.y, y + s * inner.x + c * inner.y, wrapAngle(theta + inner.theta)};
    }
    /// The frame that this pose is given in, as a pose in the frame of this one.
    Pose2D inverse() const {
        const double c = std::cos(theta), s = std::sin(theta);
        return {-c * x - s * y, s * x - c * y, wrapAngle(-theta)};
    }
};

/// What the exponential of SE(2) makes of a turn by an angle (rad): sin(a) / a and (1 - cos(a)) / a.
struct ArcFactors {
    double sine, versine;

    explicit ArcFactors(double a) {
        const bool isSmall = std::abs(a) < 1e-4; // where the fractions lose digits; the series have 1e-17
        sine = isSmall ? 1 - a * a / 6 : std::sin(a) / a;
        versine = isSmall ? a / 2 - a * a * a / 24 : (1 - std::cos(a)) / a;
    }
};

/// Velocity of a sensor or a robot in its own frame: x forward, y left (m/s), omega counter-clockwise
/// (rad/s).
struct Twist2D {
    double vx = 0;
    double vy = 0;
    double omega = 0;

    /// The motion over `seconds` at this velocity, along an arc: the exponential of SE(2).
    Pose2D motion(double seconds) const {
        const double a = omega * seconds;
        const auto [s, c] = ArcFactors(a);
        return {(s * vx - c * vy) * seconds, (c * vx + s * vy) * seconds, a};
    }
    /// The velocity that makes this motion in `seconds`.
    static Twist2D between(const Pose2D &motion, double seconds) {
        const double a = motion.theta, half = a / 2;
        const double k = std::abs(half) < 1e-4 ? 1 - half * half / 3 : half / std::tan(half);
        return {(k * motion.x + half * motion.y) / seconds, (k * motion.y - half * motion.x) / seconds,
                a / seconds};
    }
};

} // namespace vectorlib
