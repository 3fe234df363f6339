#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/tls/TlsSums.h"

#include <Eigen/Core>

namespace vectorlib {

/// One Gauss-Newton step that brings the points of dynamic edges onto the lines of static ones: the sum of
/// squared distances of all points, computed from their sums alone, so that a pair costs the same whatever
/// its points.
///
/// With a unit normal n of the static line and a point x, the residual is r = n.(x + t + alpha x') - n.s,
/// where x' is x turned by +90 degrees and s any point of the static line. For a small alpha this is linear
/// in (t, alpha); the normal equations need only the count, mean and second moments of the points.
class PointToLineRefinement {
public:
    /// A prior that the step is zero; standard deviations in metres and radians, relative to noise of 1
    /// metre.
    void start(double weightXY, double weightAlpha);
    /// Points with `sums` belong onto `fixed`. Working frame: near the sensor.
    void add(const LineSegment2D<double> &fixed, const TlsSums &sums, double weight) {
        accumulate(fixed, sums, weight, 1);
    }
    /// Static points with `sums` belong onto `moving`, which the step moves: to first order they move the
    /// other way.
    void addStatic(const LineSegment2D<double> &moving, const TlsSums &sums, double weight) {
        accumulate(moving, sums, weight, -1);
    }
    /// The step (to be multiplied from the left); identity when the equations are singular.
    Transformation2D step() const;
    const Eigen::Matrix3d &information() const { return h_; }

private:
    void accumulate(const LineSegment2D<double> &line, const TlsSums &sums, double weight, double sign);

    Eigen::Matrix3d h_ = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g_ = Eigen::Vector3d::Zero();
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/registration/PointToLineRefinement.cpp")
