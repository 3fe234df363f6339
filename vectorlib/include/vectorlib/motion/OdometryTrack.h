#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/motion/OdometrySample.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace vectorlib {

/// The robot's way during one scan, by its odometry.
class OdometryTrack {
public:
    /// The samples are one or more, in order of time; either all have a covariance or none.
    OdometryTrack(std::uint64_t epoch, std::vector<OdometrySample> samples);

    /// Tracks of different epochs do not belong together: the odometry began anew between them.
    std::uint64_t epoch() const { return epoch_; }
    /// The robot in the odometry's frame, on an arc between two samples; beyond the last one as its twist
    /// says.
    Transformation2D at(double stamp) const;
    /// The covariance of the odometry at a time (seconds), between two samples in proportion; as
    /// OdometrySample::covariance.
    std::optional<Eigen::Matrix3d> covarianceAt(double stamp) const;

private:
    std::size_t knotBefore(double stamp) const;

    std::uint64_t epoch_;
    std::vector<OdometrySample> knots_; // the twist of each is that until the next one
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/motion/OdometryTrack.cpp")
