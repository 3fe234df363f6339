#include "daemons/scanmatcher/OdometryModel.h"

#include <algorithm>
#include <cmath>

namespace hermes {

using vectorlib::Transformation2D;

namespace {

// What the uncertainty grew by on the way from one pose to another, of which both hold the sum since the
// start: Q = P2 - F P1 F', where F tells what a wrong heading at the first pose does to the second.
Eigen::Matrix3d growth(const Transformation2D &from, const Eigen::Matrix3d &before,
                       const Transformation2D &to, const Eigen::Matrix3d &after) {
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    f(0, 2) = from.y() - to.y();
    f(1, 2) = to.x() - from.x();
    return after - f * before * f.transpose();
}

double deviation(double least, double variance) {
    return std::sqrt(least * least + std::max(0.0, variance)); // rounding may make a zero negative
}

} // namespace

void OdometryModel::setMount(const vectorlib::Pose2D &sensor) {
    mount_ = Transformation2D(sensor);
}

Transformation2D OdometryModel::ofSensor(const Transformation2D &robotMotion) const {
    return mount_.inverse() * robotMotion * mount_;
}

void OdometryModel::update(const vectorlib::Pose2D &pose, const OdometryTrack &track, double stamp) {
    last_ = Last{track.epoch(), Transformation2D(pose), track.at(stamp), track.covarianceAt(stamp)};
}

std::optional<OdometryModel::Expectation> OdometryModel::expect(const OdometryTrack &track,
                                                                double stamp) const {
    if (!last_ || last_->epoch != track.epoch())
        return std::nullopt;
    const Transformation2D robot = track.at(stamp);
    const Eigen::Matrix3d q = growth(last_->robot, last_->covariance, robot, track.covarianceAt(stamp));
    return Expectation{(last_->pose * ofSensor(last_->robot.inverse() * robot)).pose(),
                       deviation(leastDeviationXY, std::max(q(0, 0), q(1, 1))),
                       deviation(leastDeviationAlpha, q(2, 2))};
}

vectorlib::Twist2D OdometryModel::twist(const OdometryTrack &track, double begin, double end) const {
    if (!(end > begin))
        return {};
    return vectorlib::Twist2D::between(ofSensor(track.at(begin).inverse() * track.at(end)), end - begin);
}

} // namespace hermes
