#pragma once

#include "common/world/World.h"
#include "protocol/messages/Motion.h"
#include "vectorlib/geometry/Pose2D.h"

#include <algorithm>
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

/// Moves along a path: speeds up, drives at full speed, comes to rest at the end or when halted. Time comes
/// from outside.
class PathFollower {
public:
    PathFollower() = default;
    /// acceleration: of the rate along the path; 1/s^2, that is the robot's acceleration over its speed.
    PathFollower(PosePath path, double acceleration)
        : path_(std::move(path))
        , acceleration_(acceleration) {}

    /// Goes on from where it is.
    void drive() { driving_ = !path_.isEmpty(); }
    /// Slows down and stops.
    void halt() { driving_ = false; }
    /// Back to the start, standing.
    void restart() { progress_ = rate_ = 0; }
    void advance(double seconds);

    const PosePath &path() const { return path_; }
    double progress() const { return progress_; } ///< seconds at full speed
    double rate() const { return rate_; }         ///< 0 standing, 1 at full speed
    bool isDriving() const { return driving_; }
    bool isFinished() const { return progress_ >= path_.length(); }
    Pose2D pose() const { return path_.poseAt(progress_); }
    Twist2D twist() const { return path_.twistAt(progress_, rate_); }

private:
    PosePath path_;
    double acceleration_ = 1;
    double progress_ = 0;
    double rate_ = 0;
    bool driving_ = false;
};

} // namespace hermes::simulator
