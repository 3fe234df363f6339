#include "vectorlib/motion/OdometryTrack.h"

#include <utility>

namespace vectorlib {

VECTORLIB_BODY OdometryTrack::OdometryTrack(std::uint64_t epoch, std::vector<OdometrySample> samples)
    : epoch_(epoch)
    , knots_(std::move(samples)) {
    for (std::size_t i = 0; i + 1 < knots_.size(); ++i)
        knots_[i].twist = Twist2D::between(knots_[i].pose.inverse() * knots_[i + 1].pose,
                                           knots_[i + 1].stamp - knots_[i].stamp);
}

VECTORLIB_BODY Transformation2D OdometryTrack::at(double stamp) const {
    const OdometrySample &knot = knots_[knotBefore(stamp)];
    return Transformation2D(knot.pose * knot.twist.motion(stamp - knot.stamp));
}

VECTORLIB_BODY std::optional<Eigen::Matrix3d> OdometryTrack::covarianceAt(double stamp) const {
    const std::size_t i = knotBefore(stamp);
    if (i + 1 == knots_.size() || !knots_[i].covariance || !knots_[i + 1].covariance)
        return knots_[i].covariance;
    const double share = (stamp - knots_[i].stamp) / (knots_[i + 1].stamp - knots_[i].stamp);
    return *knots_[i].covariance + share * (*knots_[i + 1].covariance - *knots_[i].covariance);
}

VECTORLIB_BODY std::size_t OdometryTrack::knotBefore(double stamp) const {
    std::size_t i = knots_.size() - 1; // a turn holds a handful
    while (i > 0 && knots_[i].stamp > stamp)
        --i;
    return i;
}

} // namespace vectorlib
