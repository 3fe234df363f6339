#include "daemons/scanmatcher/OdometryTrack.h"

namespace hermes {

using vectorlib::Transformation2D;
using vectorlib::Twist2D;

OdometryTrack::OdometryTrack(quint64 epoch, std::vector<OdometrySample> samples)
    : epoch_(epoch) {
    knots_.reserve(samples.size());
    for (const OdometrySample &s : samples)
        knots_.push_back({s.stamp, Transformation2D(s.pose), s.twist, s.covariance});
    for (std::size_t i = 0; i + 1 < knots_.size(); ++i)
        knots_[i].twist = Twist2D::between(knots_[i].pose.inverse() * knots_[i + 1].pose,
                                           knots_[i + 1].stamp - knots_[i].stamp);
}

std::size_t OdometryTrack::knotBefore(double stamp) const {
    std::size_t i = knots_.size() - 1; // a turn holds a handful
    while (i > 0 && knots_[i].stamp > stamp)
        --i;
    return i;
}

Transformation2D OdometryTrack::at(double stamp) const {
    const Knot &knot = knots_[knotBefore(stamp)];
    return knot.pose * knot.twist.motion(stamp - knot.stamp);
}

Eigen::Matrix3d OdometryTrack::covarianceAt(double stamp) const {
    const std::size_t i = knotBefore(stamp);
    if (i + 1 == knots_.size())
        return knots_[i].covariance;
    const double share = (stamp - knots_[i].stamp) / (knots_[i + 1].stamp - knots_[i].stamp);
    return knots_[i].covariance + share * (knots_[i + 1].covariance - knots_[i].covariance);
}

} // namespace hermes
