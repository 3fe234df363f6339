#pragma once

#include "vectorlib/geometry/Transformation2D.h"

namespace vectorlib {

/// Velocity of a sensor or a robot in its own frame; m/s and rad/s.
struct Twist2D {
    double vx = 0;
    double vy = 0;
    double omega = 0;

    /// The motion over `seconds` at this velocity, along an arc.
    Transformation2D motion(double seconds) const {
        const double a = omega * seconds;
        // sin(a)/a and (1 - cos(a))/a, also for small a
        const double s = std::abs(a) < 1e-6 ? 1 - a * a / 6 : std::sin(a) / a;
        const double c = std::abs(a) < 1e-6 ? a / 2 : (1 - std::cos(a)) / a;
        return {(s * vx - c * vy) * seconds, (c * vx + s * vy) * seconds, a};
    }
    /// The velocity that makes this motion in `seconds`.
    static Twist2D between(const Transformation2D &motion, double seconds) {
        const double a = motion.alpha(), half = a / 2;
        const double k = std::abs(half) < 1e-6 ? 1 : half / std::tan(half);
        return {(k * motion.x() + half * motion.y()) / seconds,
                (k * motion.y() - half * motion.x()) / seconds, a / seconds};
    }
};

} // namespace vectorlib
