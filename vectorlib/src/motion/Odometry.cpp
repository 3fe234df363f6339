#include "vectorlib/motion/Odometry.h"
#include "vectorlib/geometry/SmallMatrix.h"

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

VECTORLIB_BODY OdometryBuffer::Outcome OdometryBuffer::add(const OdometrySample &added) {
    Outcome outcome = Outcome::Taken;
    if (size_ > 0) {
        const OdometrySample &last = sample(size_ - 1);
        if (added.stamp <= last.stamp && added.stamp >= last.stamp - longestGap_s)
            return Outcome::OutOfOrder;
        if (!follows(last, added)) {
            restart();
            outcome = Outcome::Restarted;
        }
    }
    if (size_ == capacity)
        first_ = (first_ + 1) % capacity;
    else
        ++size_;
    ring_[(first_ + size_ - 1) % capacity] = added;
    return outcome;
}

VECTORLIB_BODY void OdometryBuffer::restart() {
    first_ = size_ = 0;
    ++epoch_;
}

VECTORLIB_BODY std::optional<OdometryTrack> OdometryBuffer::over(double begin, double end) const {
    if (size_ == 0 || !(begin <= end) || sample(0).stamp > begin ||
        sample(size_ - 1).stamp < end - longestForesight_s)
        return std::nullopt;
    std::size_t from = size_ - 1;
    while (from > 0 && sample(from).stamp > begin)
        --from;
    std::vector<OdometrySample> samples;
    for (std::size_t i = from; i < size_; ++i) {
        samples.push_back(sample(i));
        if (sample(i).stamp >= end)
            break;
    }
    return OdometryTrack(epoch_, std::move(samples));
}

VECTORLIB_BODY bool OdometryBuffer::follows(const OdometrySample &before, const OdometrySample &after) {
    const double seconds = after.stamp - before.stamp;
    const double speed =
        std::max(std::hypot(before.twist.vx, before.twist.vy), std::hypot(after.twist.vx, after.twist.vy));
    const double rate = std::max(std::abs(before.twist.omega), std::abs(after.twist.omega));
    const double way = std::hypot(after.pose.x - before.pose.x, after.pose.y - before.pose.y);
    const double turn = std::abs(wrapAngle(after.pose.theta - before.pose.theta));
    // Nothing but a reset makes the heading more certain.
    const bool surer =
        before.covariance && after.covariance && (*after.covariance)(2, 2) < (*before.covariance)(2, 2);
    return std::abs(seconds) <= longestGap_s && way <= jump_m + 2 * speed * seconds &&
           turn <= jump_rad + 2 * rate * seconds && !surer &&
           before.covariance.has_value() == after.covariance.has_value();
}

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

VECTORLIB_BODY bool OdometryCheck::Ways::differ() const {
    const double apart = std::hypot(scans.x - odometry.x, scans.y - odometry.y);
    const double turned = std::abs(wrapAngle(scans.theta - odometry.theta));
    return apart > std::max(least_m, share * std::hypot(odometry.x, odometry.y)) ||
           turned > std::max(least_rad, share * std::abs(odometry.theta));
}

VECTORLIB_BODY bool OdometryCheck::add(double stamp, const Pose2D &odometry, const Pose2D &scans) {
    const Point end{stamp, odometry, scans};
    if (!begin_ || stamp <= begin_->stamp) {
        restart();
        begin_ = end;
        return false;
    }
    const Ways piece = begin_->to(end);
    constexpr double patience_s = 0.5; // poses that leap for a moment are no way
    const auto went = [](const Pose2D &way, double part) {
        return std::hypot(way.x, way.y) >= part * piece_m || std::abs(way.theta) >= part * piece_rad;
    };
    // Wheels may turn faster than they tell; but one that is pushed while it stands is not driven.
    const bool byScans = went(piece.scans, 1) && went(piece.odometry, 0.1) && piece.seconds >= patience_s;
    if (!went(piece.odometry, 1) && !byScans)
        return false;
    contradiction_.reset();
    if (piece.differ() && before_ && before_->to(end).differ()) // not a single pose that was wrong
        contradiction_ = before_->to(end);
    before_ = piece.differ() ? begin_ : std::nullopt;
    begin_ = end;
    return contradiction_.has_value();
}

} // namespace vectorlib
