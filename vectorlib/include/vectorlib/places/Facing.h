#pragma once

#include "vectorlib/geometry/Vector2D.h"

#include <cstdint>

namespace vectorlib {

/// Which eighth of a turn a direction lies in, 0 to 7 counter-clockwise from the x axis.
template <typename Scalar>
int octantOf(Vector2D<Scalar> d) {
    int octant = 0;
    if (d.y < 0) {
        d = -d;
        octant = 4;
    }
    if (d.x < 0) {
        d = {d.y, -d.x};
        octant += 2;
    }
    return (octant + (d.y > d.x)) & 7;
}

/// One bit for the eighth of a turn that a wall faces: its direction with free space on the left.
template <typename Scalar>
std::uint8_t facingBit(Vector2D<Scalar> direction) {
    return static_cast<std::uint8_t>(1u << octantOf(direction));
}

/// The bits of all directions within 25 degrees of a wall's.
inline std::uint8_t facingBits(Vector2D<double> direction) {
    constexpr double cosine = 0.9063, sine = 0.4226;
    const Vector2D<double> d = direction;
    return static_cast<std::uint8_t>(
        facingBit(d) | facingBit(Vector2D<double>(cosine * d.x - sine * d.y, sine * d.x + cosine * d.y)) |
        facingBit(Vector2D<double>(cosine * d.x + sine * d.y, cosine * d.y - sine * d.x)));
}

} // namespace vectorlib
