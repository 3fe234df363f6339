#include "vectorlib/motion/OpenDirection.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY void OpenDirection::follow(const Transformation2D &pose, bool isOpen, bool isByOdometry,
                                          bool grows, const std::optional<OdometryTrack> &odometry,
                                          double stamp, const Transformation2D &mount) {
    const double way = last_ ? (pose.translation() - last_->translation()).norm() : 0;
    last_ = pose;
    if (!isOpen)
        disputed_ = {};
    if (grows) {
        const double beside = std::max(0.0, 1 - way / beside_m);
        deviation_ *= beside;
        disputed_ = disputed_ * beside;
    }
    deviation_ = isOpen ? deviation_ + (isByOdometry ? slip_ : unguided) * way : 0;
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
