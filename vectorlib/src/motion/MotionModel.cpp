#include "vectorlib/motion/MotionModel.h"

namespace vectorlib {

VECTORLIB_BODY void MotionModel::update(const Pose2D &pose, double stamp) {
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

VECTORLIB_BODY void MotionModel::reset(const Pose2D &pose) {
    pose_ = pose;
    twist_ = Twist2D();
    known_ = velocityKnown_ = false;
}

VECTORLIB_BODY Pose2D MotionModel::predict(double stamp) const {
    const double seconds = stamp - stamp_;
    if (!known_ || !(seconds > 0) || seconds > maxGap)
        return pose_;
    return pose_ * twist_.motion(seconds);
}

} // namespace vectorlib
