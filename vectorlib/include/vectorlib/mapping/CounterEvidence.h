#pragma once

#include "vectorlib/geometry/Pose2D.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

/// What speaks against the pose in a finished map, over the last scans: the mean of PlaceFit::against over
/// half a second, or over five scans where these take less. Less what was known when the place was found, as
/// the world may have changed; that is forgotten on the way.
class CounterEvidence {
public:
    /// The sensor was put at a pose, against which so much is known to speak.
    void place(const Pose2D &pose, double known) {
        mean_ = known_ = known;
        scans_ = 0;
        at_ = pose;
    }
    /// The map grows: nothing speaks against a pose in it.
    void forget() { mean_ = known_ = scans_ = 0; }
    /// So much speaks against the pose of a scan that came `seconds` after the one before.
    void take(double against, const Pose2D &pose, double seconds) {
        mean_ +=
            std::max({leastShare, 1 - std::exp(-seconds / smoothed_s), 1.0 / ++scans_}) * (against - mean_);
        if (std::hypot(pose.x - at_.x, pose.y - at_.y) < forgetting_m)
            return;
        known_ *= 1 - forgottenShare;
        at_ = pose;
    }
    double value() const { return std::max(0.0, mean_ - known_); }

private:
    static constexpr double smoothed_s = 0.5, leastShare = 0.2; // by which the mean follows a scan
    static constexpr double forgetting_m = 0.1,
                            forgottenShare = 0.1; // of what was known, each so many metres

    double mean_ = 0, known_ = 0;
    int scans_ = 0; // since the sensor was put somewhere
    Pose2D at_;     // what was known is forgotten from there on
};

} // namespace vectorlib
