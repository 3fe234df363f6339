#pragma once

#include "vectorlib/geometry/Twist2D.h"

namespace vectorlib {

/// Where a sensor is expected next when it goes on as between its last two poses.
class MotionModel {
public:
    double maxGap =
        1.0; ///< after a longer pause, or a stamp that steps back, the velocity is forgotten; seconds
    double lastStepShare = 0.5; ///< of the last step in the velocity; less is smoother and later

    /// The sensor was at `pose` at the time `stamp`; seconds.
    void update(const Pose2D &pose, double stamp) {
        const double seconds = stamp - stamp_;
        if (!known_ || !(seconds > 0) || seconds > maxGap) {
            twist_ = Twist2D();
            velocityKnown_ = false;
        } else {
            const Twist2D last = Twist2D::between(pose_.inverse() * pose, seconds);
            const double k = velocityKnown_ ? lastStepShare : 1;
            twist_ = {twist_.vx + k * (last.vx - twist_.vx), twist_.vy + k * (last.vy - twist_.vy),
                      twist_.omega + k * (last.omega - twist_.omega)};
            velocityKnown_ = true;
        }
        pose_ = pose;
        stamp_ = stamp;
        known_ = true;
    }
    /// Puts the sensor somewhere else, standing still.
    void reset(const Pose2D &pose) {
        pose_ = pose;
        twist_ = Twist2D();
        known_ = velocityKnown_ = false;
    }
    /// All poses so far lie elsewhere: in another frame, or the map was corrected.
    void move(const Transformation2D &moved) { pose_ = (moved * Transformation2D(pose_)).pose(); }
    /// Where it is expected at the time `stamp`, seconds: the last pose where the velocity is not known.
    Pose2D predict(double stamp) const {
        const double seconds = stamp - stamp_;
        if (!known_ || !(seconds > 0) || seconds > maxGap)
            return pose_;
        return pose_ * twist_.motion(seconds);
    }
    const Pose2D &pose() const { return pose_; }
    /// Smoothed over the last steps; zero when unknown.
    const Twist2D &twist() const { return twist_; }

private:
    Pose2D pose_;
    Twist2D twist_;
    double stamp_ = 0;
    bool known_ = false;
    bool velocityKnown_ = false;
};

} // namespace vectorlib
