#pragma once

#include <cmath>

namespace vectorlib {

/// Half a turn in radians.
constexpr double pi = 3.14159265358979323846;

/// The same angle in (-pi, pi]; radians. NaN and infinity give NaN.
inline double wrapAngle(double angle) {
    if (angle > -pi && angle <= pi)
        return angle; // as nearly always: the remainder is slow
    angle = std::remainder(angle, 2 * pi);
    return angle <= -pi ? angle + 2 * pi : angle;
}

} // namespace vectorlib
