#pragma once

#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/io/Number.h"

#include <cmath>
#include <vector>

namespace vectorlib {

/// A pose and when it was taken.
struct StampedPose {
    double stamp = 0; ///< seconds
    Pose2D pose;
};

/// A trajectory in the format of the TUM benchmark: `stamp x y z qx qy qz qw`, one pose a line; seconds,
/// metres.
inline void writeTum(std::ostream &out, const std::vector<StampedPose> &trajectory) {
    for (const StampedPose &p : trajectory)
        out << Number(p.stamp) << ' ' << Number(p.pose.x) << ' ' << Number(p.pose.y) << " 0 0 0 "
            << Number(std::sin(p.pose.theta / 2)) << ' ' << Number(std::cos(p.pose.theta / 2)) << '\n';
}

} // namespace vectorlib
