#pragma once

#include <cmath>

namespace vectorlib {

constexpr double pi = 3.14159265358979323846;

/// The same angle in (-pi, pi]; radians. NaN and infinity give NaN.
inline double wrapAngle(double angle) {
    angle = std::remainder(angle, 2 * pi);
    return angle <= -pi ? angle + 2 * pi : angle;
}

} // namespace vectorlib
