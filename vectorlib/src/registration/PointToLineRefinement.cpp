#include "vectorlib/registration/PointToLineRefinement.h"

#include "vectorlib/geometry/SmallMatrix.h"

#include <optional>

namespace vectorlib {

VECTORLIB_BODY void PointToLineRefinement::start(double weightXY, double weightAlpha) {
    h_ = Eigen::Vector3d(weightXY, weightXY, weightAlpha).asDiagonal();
    g_.setZero();
}

VECTORLIB_BODY Transformation2D PointToLineRefinement::step() const {
    const std::optional<Eigen::Vector3d> back = solveSymmetric(h_, g_);
    return back ? Transformation2D(-(*back)(0), -(*back)(1), -(*back)(2)) : Transformation2D();
}

VECTORLIB_BODY void PointToLineRefinement::accumulate(const LineSegment2D<double> &line, const TlsSums &sums,
                                                      double weight, double sign) {
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

} // namespace vectorlib
