#pragma once

#include "vectorlib/geometry/SmallMatrix.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/tls/TlsSums.h"

#include <Eigen/Core>
#include <optional>

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
    void start(double weightXY, double weightAlpha) {
        h_ = Eigen::Vector3d(weightXY, weightXY, weightAlpha).asDiagonal();
        g_.setZero();
    }
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
    Transformation2D step() const {
        const std::optional<Eigen::Vector3d> back = solveSymmetric(h_, g_);
        return back ? Transformation2D(-(*back)(0), -(*back)(1), -(*back)(2)) : Transformation2D();
    }
    const Eigen::Matrix3d &information() const { return h_; }

private:
    void accumulate(const LineSegment2D<double> &line, const TlsSums &sums, double weight, double sign) {
        const Vector2D<double> n = line.normal(), w(n.y, -n.x); // n . x' = w . x
        const double u = w.dot(sums.mean), r = n.dot(sums.mean - line.begin());
        const double uu = w.x * w.x * sums.xx + 2 * w.x * w.y * sums.xy + w.y * w.y * sums.yy;
        const double ur = w.x * n.x * sums.xx + (w.x * n.y + w.y * n.x) * sums.xy + w.y * n.y * sums.yy;
        const Eigen::Vector3d j(n.x, n.y, u);
        h_ += square(weight * sums.n, j);
        h_(2, 2) += weight * uu;
        g_ += (sign * weight * sums.n * r) * j;
        g_(2) += sign * weight * ur;
    }

    Eigen::Matrix3d h_ = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g_ = Eigen::Vector3d::Zero();
};

} // namespace vectorlib
