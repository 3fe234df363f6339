#include "vectorlib/motion/OdometryModel.h"

#include "vectorlib/geometry/SmallMatrix.h"

namespace vectorlib {

VECTORLIB_BODY std::optional<OdometryModel::Expectation> OdometryModel::expect(const OdometryTrack &track,
                                                                               double stamp) const {
    if (!last_ || last_->epoch != track.epoch())
        return std::nullopt;
    const Transformation2D robot = track.at(stamp);
    Expectation e{(last_->pose * ofSensor(last_->robot.inverse() * robot)).pose(), std::nullopt};
    const auto covariance = track.covarianceAt(stamp);
    if (covariance && last_->covariance) {
        const Eigen::Matrix3d q = growth(last_->robot, *last_->covariance, robot, *covariance);
        e.deviations = Deviations{deviation(leastDeviationXY, std::max(q(0, 0), q(1, 1))),
                                  deviation(leastDeviationAlpha, q(2, 2))};
    }
    return e;
}

VECTORLIB_BODY void OdometryModel::move(const Transformation2D &moved) {
    if (last_)
        last_->pose = moved * last_->pose;
}

VECTORLIB_BODY std::optional<Transformation2D> OdometryModel::frame() const {
    if (!last_)
        return std::nullopt;
    return last_->pose * mount_.inverse() * last_->robot.inverse();
}

VECTORLIB_BODY Twist2D OdometryModel::twist(const OdometryTrack &track, double begin, double end) const {
    if (!(end > begin))
        return {};
    const Transformation2D motion = ofSensor(track.at(begin).inverse() * track.at(end));
    return Twist2D::between(motion.pose(), end - begin);
}

VECTORLIB_BODY Eigen::Matrix3d OdometryModel::growth(const Transformation2D &from,
                                                     const Eigen::Matrix3d &before,
                                                     const Transformation2D &to,
                                                     const Eigen::Matrix3d &after) {
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    f(0, 2) = from.y() - to.y();
    f(1, 2) = to.x() - from.x();
    return after - product(f, before, f);
}

} // namespace vectorlib
