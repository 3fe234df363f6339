#pragma once

#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/motion/OdometrySample.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace vectorlib {

/// The robot's way during one scan, by its odometry.
class OdometryTrack {
public:
    /// The samples are one or more, in order of time; either all have a covariance or none.
    OdometryTrack(std::uint64_t epoch, std::vector<OdometrySample> samples)
        : epoch_(epoch)
        , knots_(std::move(samples)) {
        for (std::size_t i = 0; i + 1 < knots_.size(); ++i)
            knots_[i].twist = Twist2D::between(knots_[i].pose.inverse() * knots_[i + 1].pose,
                                               knots_[i + 1].stamp - knots_[i].stamp);
    }

    /// Tracks of different epochs do not belong together: the odometry began anew between them.
    std::uint64_t epoch() const { return epoch_; }
    /// The robot in the odometry's frame, on an arc between two samples; beyond the last one as its twist
    /// says.
    Transformation2D at(double stamp) const {
        const OdometrySample &knot = knots_[knotBefore(stamp)];
        return Transformation2D(knot.pose * knot.twist.motion(stamp - knot.stamp));
    }
    /// The covariance of the odometry at a time (seconds), between two samples in proportion; as
    /// OdometrySample::covariance.
    std::optional<Eigen::Matrix3d> covarianceAt(double stamp) const {
        const std::size_t i = knotBefore(stamp);
        if (i + 1 == knots_.size() || !knots_[i].covariance || !knots_[i + 1].covariance)
            return knots_[i].covariance;
        const double share = (stamp - knots_[i].stamp) / (knots_[i + 1].stamp - knots_[i].stamp);
        return *knots_[i].covariance + share * (*knots_[i + 1].covariance - *knots_[i].covariance);
    }

private:
    std::size_t knotBefore(double stamp) const {
        std::size_t i = knots_.size() - 1; // a turn holds a handful
        while (i > 0 && knots_[i].stamp > stamp)
            --i;
        return i;
    }

    std::uint64_t epoch_;
    std::vector<OdometrySample> knots_; // the twist of each is that until the next one
};

} // namespace vectorlib
