#pragma once

#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/io/Number.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace vectorlib {

/// A pose and when it was taken.
struct StampedPose {
    double stamp = 0; ///< seconds
    Pose2D pose;
};

/// What writeTum() changed so that the stamps ascend.
struct StampMend {
    std::size_t moved = 0;     ///< stamps written other than given
    std::size_t ties = 0;      ///< stamps given that are the one before
    std::size_t stepsBack = 0; ///< stamps given that are earlier than the one before
    double farthest = 0;       ///< largest distance that a stamp was moved, seconds
};

/// A trajectory in the format of the TUM benchmark: `stamp x y z qx qy qz qw`, one pose a line; seconds,
/// metres. Readers take one pose a stamp and divide by the time between: the stamps are written strictly
/// ascending. The poses keep their order; a stamp that is not later than the one before is moved to a
/// microsecond behind it (the last decimal of the benchmark's files), all others stay as they are.
inline StampMend writeTum(std::ostream &out, const std::vector<StampedPose> &trajectory) {
    constexpr double step = 1e-6;
    StampMend mend;
    double kept = 0, given = 0, last = -std::numeric_limits<double>::infinity();
    std::size_t behind = 0; // stamps moved since the one kept; counted, so that rounding does not add up
    for (const StampedPose &p : trajectory) {
        const bool isFirst = &p == &trajectory.front();
        mend.ties += !isFirst && p.stamp == given;
        mend.stepsBack += !isFirst && p.stamp < given;
        given = p.stamp;
        if (p.stamp > last) {
            kept = last = p.stamp;
            behind = 0;
        } else {
            const double next = std::nextafter(last, std::numeric_limits<double>::infinity());
            last = std::max(kept + double(++behind) * step, next);
            ++mend.moved;
            mend.farthest = std::max(mend.farthest, last - p.stamp);
        }
        out << Number(last) << ' ' << Number(p.pose.x) << ' ' << Number(p.pose.y) << " 0 0 0 "
            << Number(std::sin(p.pose.theta / 2)) << ' ' << Number(std::cos(p.pose.theta / 2)) << '\n';
    }
    return mend;
}

} // namespace vectorlib
