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

} // namespace vectorlib
