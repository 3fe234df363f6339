#pragma once

#include "daemons/simulator/PosePath.h"

namespace hermes::simulator {

/// Moves along a path: speeds up, drives at full speed, comes to rest at the end or when halted. Time comes
/// from outside.
class PathFollower {
public:
    PathFollower() = default;
    /// acceleration: of the rate along the path; 1/s^2, that is the robot's acceleration over its speed.
    PathFollower(PosePath path, double acceleration);

    /// Goes on from where it is.
    void drive() { driving_ = !path_.isEmpty(); }
    /// Slows down and stops.
    void halt() { driving_ = false; }
    /// Back to the start, standing.
    void restart();
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
