#include "vectorlib/motion/OpenDirection.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY void OpenDirection::follow(const Transformation2D &pose, bool isOpen, bool isByOdometry,
                                          bool grows, const std::optional<OdometryTrack> &odometry,
                                          double stamp, const Transformation2D &mount) {
    const double way = last_ ? (pose.translation() - last_->translation()).norm() : 0;
    const double pause = last_ ? std::clamp(stamp - lastStamp_, 0.0, longestPause_s) : 0;
    last_ = pose;
    lastStamp_ = stamp;
    if (!isOpen)
        disputed_ = {};
    if (grows) {
        const double beside = std::max(0.0, 1 - way / beside_m);
        deviation_ *= beside;
        disputed_ = disputed_ * beside;
    }
    const double errs = isByOdometry ? slip_ * way : std::max(unguided * way, unseen_mps * pause);
    deviation_ = isOpen ? deviation_ + errs : 0;
    if (odometry && !isOpen)
        learn(pose, odometry->epoch(), odometry->at(stamp) * mount);
    else
        from_.reset();
}

VECTORLIB_BODY void OpenDirection::learn(const Transformation2D &pose, std::uint64_t epoch,
                                         const Transformation2D &sensor) {
    if (from_ && from_->epoch == epoch) {
        const Vector2D<double> told = (from_->sensor.inverse() * sensor).translation(),
                               seen = (from_->pose.inverse() * pose).translation();
        const double length = std::max(told.norm(), seen.norm());
        if (length < piece_m)
            return;
        const double wrong = std::min(1.0, (told - seen).norm() / length);
        slip_ = std::max(leastSlip, std::sqrt(kept * slip_ * slip_ + (1 - kept) * wrong * wrong));
    }
    from_ = From{epoch, sensor, pose};
}

} // namespace vectorlib
