#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <Eigen/Core>

#include <cstddef>

namespace vectorlib {

/// A measured motion between two poses of a graph.
struct PoseConstraint {
    std::size_t from = 0, to = 0; ///< numbers of the poses
    Transformation2D motion;      ///< of pose `to` in the frame of pose `from`; metres, radians
    /// Inverse covariance of x, y and alpha, in the frame of pose `from`.
    Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
    bool mayBeWrong = false; ///< altogether: then it loses its weight where the others contradict it
    double weight = 1;       ///< in [0, 1], found with the poses

    /// Whether the other motions contradict it, so that it counts little.
    bool isRefused() const;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/graph/PoseConstraint.cpp")
