#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Angle.h"

#include <vector>

namespace vectorlib {

/// A histogram of the rotations that pairs of segments ask for; its peaks are the rotations worth trying.
class RotationVotes {
public:
    /// Begins anew for rotations of at most `limit`; radians.
    void start(double limit);
    /// A pair asks for a rotation (radians); one beyond the limit is left out.
    void add(double alpha, double weight);
    /// The strongest rotations, best first, at most `count` and none next to a better one; radians.
    const std::vector<double> &peaks(int count);

private:
    static constexpr double bin = pi / 90; // 2 degrees
    int half_ = 0;
    std::vector<double> votes_;
    std::vector<double> peaks_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/RotationVotes.cpp")
