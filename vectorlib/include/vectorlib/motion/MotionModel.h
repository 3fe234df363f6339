#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Twist2D.h"

namespace vectorlib {

/// Where a sensor is expected next when it goes on as between its last two poses.
class MotionModel {
public:
    double maxGap =
        1.0; ///< after a longer pause, or a stamp that steps back, the velocity is forgotten; seconds
    double lastStepShare = 0.5; ///< of the last step in the velocity; less is smoother and later

    /// The sensor was at `pose` at the time `stamp`; seconds.
    void update(const Pose2D &pose, double stamp);
    /// Puts the sensor somewhere else, standing still.
    void reset(const Pose2D &pose);
    /// All poses so far lie elsewhere: in another frame, or the map was corrected.
    void move(const Transformation2D &moved) { pose_ = (moved * Transformation2D(pose_)).pose(); }
    /// Where it is expected at the time `stamp`, seconds: the last pose where the velocity is not known.
    Pose2D predict(double stamp) const;
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

#include VECTORLIB_BODIES("vectorlib/src/motion/MotionModel.cpp")
