#pragma once

#include "daemons/scanmatcher/OdometrySample.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <vector>

namespace hermes {

/// The robot's way during one scan, by its odometry.
class OdometryTrack {
public:
    /// The samples are one or more, in order of time.
    OdometryTrack(quint64 epoch, std::vector<OdometrySample> samples);

    /// Tracks of different epochs do not belong together: the odometry began anew between them.
    quint64 epoch() const { return epoch_; }
    /// The robot in the odometry's frame, on an arc between two samples; beyond the last one as its twist
    /// says.
    vectorlib::Transformation2D at(double stamp) const;
    Eigen::Matrix3d covarianceAt(double stamp) const;

private:
    struct Knot {
        double stamp;
        vectorlib::Transformation2D pose;
        vectorlib::Twist2D twist; // until the next knot
        Eigen::Matrix3d covariance;
    };
    std::size_t knotBefore(double stamp) const;

    quint64 epoch_;
    std::vector<Knot> knots_;
};

} // namespace hermes
