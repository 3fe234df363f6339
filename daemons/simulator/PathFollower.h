#pragma once

#include "daemons/simulator/PosePath.h"

namespace hermes {

/// Moves along a path: speeds up, drives at full speed, comes to rest at the end or when halted. Time comes
/// from outside.
class PathFollower {
public:
    PathFollower() = default;
    /// acceleration: of the rate along the path; 1/s^2, that is the robot's acceleration over its speed.
    PathFollower(PosePath path, double acceleration);

    /// Goes on from where it is.
    void drive() { m_driving = !m_path.isEmpty(); }
    /// Slows down to a stand.
    void halt() { m_driving = false; }
    /// Back to the start, standing.
    void restart();
    void advance(double seconds);

    const PosePath &path() const { return m_path; }
    double progress() const { return m_progress; } ///< seconds at full speed
    double rate() const { return m_rate; }         ///< 0 standing, 1 at full speed
    bool isDriving() const { return m_driving; }
    bool isFinished() const { return m_progress >= m_path.length(); }
    vectorlib::Pose2D pose() const { return m_path.poseAt(m_progress); }
    Twist twist() const { return m_path.twistAt(m_progress, m_rate); }

private:
    PosePath m_path;
    double m_acceleration = 1;
    double m_progress = 0;
    double m_rate = 0;
    bool m_driving = false;
};

} // namespace hermes
