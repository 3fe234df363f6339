#pragma once

namespace vectorlib {

/// Position (metres) and heading (radians, counter-clockwise from the x axis) in a given frame.
struct Pose2D {
    double x = 0;
    double y = 0;
    double theta = 0;
};

} // namespace vectorlib
