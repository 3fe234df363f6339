#pragma once

#include "common/world/World.h"
#include "protocol/messages/Motion.h"
#include "vectorlib/geometry/Pose2D.h"

#include <vector>

namespace hermes::simulator {

/// A smooth path through poses: Catmull-Rom curves of position and of heading. Progress along it counts
/// seconds at full speed, so that moving one second a second keeps to the limits of speed and turn rate
/// everywhere.
class PosePath {
public:
    PosePath() = default;
    /// speed: m/s; turnRate: rad/s; both positive. Between two poses the heading turns the shorter way.
    PosePath(const std::vector<Pose2D> &poses, double speed, double turnRate);

    bool isEmpty() const { return samples_.empty(); }
    /// Seconds at full speed from the first pose to the last.
    double length() const { return samples_.empty() ? 0 : samples_.back().progress; }
    /// Beyond the ends it stands at them.
    Pose2D poseAt(double progress) const;
    /// While moving along the path at rate (1 is full speed).
    Twist2D twistAt(double progress, double rate) const;

private:
    struct Sample {
        double progress;
        double x;
        double y;
        double theta; ///< not wrapped
    };
    /// The sample at or before progress; one is always behind it.
    const Sample &sampleBefore(double progress) const;

    std::vector<Sample> samples_;
};

} // namespace hermes::simulator
