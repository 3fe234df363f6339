#include "vectorlib/registration/RegistrationCovariance.h"

#include "vectorlib/geometry/SmallMatrix.h"

#include <Eigen/LU>

namespace vectorlib {

VECTORLIB_BODY bool RegistrationCovariance::add(const SegmentPair &pair, const LineCovariance &fixed,
                                                const LineCovariance &moving) {
    solvable_ = solvable_ && isUsable(pair) && fixed.valid && moving.valid;
    if (!solvable_)
        return false;
    const Vector2D<double> n = pair.fixed.normal();
    const double lever = pair.fixed.direction().dot(translation_);
    // By the angle and the offset p of the line: what moves (x, y, alpha), before the sums are divided
    // out.
    Eigen::Matrix<double, 3, 2> byFixed, byMoving;
    byFixed << n.x * lever, n.x, n.y * lever, n.y, 1, 0;
    byMoving << 0, -n.x, 0, -n.y, -1, 0;
    const double squared = pair.weight * pair.weight;
    spread_ += squared * product(byFixed, fixed.ofSegment(pair.fixed), byFixed);
    spread_ += squared * product(byMoving, moving.ofSegment(pair.moving), byMoving);
    sums_ += square(pair.weight, Eigen::Vector3d(n.x, n.y, 0));
    sums_(2, 2) += pair.weight;
    return true;
}

VECTORLIB_BODY std::optional<Eigen::Matrix3d> RegistrationCovariance::operator()() const {
    if (!solvable_)
        return std::nullopt;
    const Eigen::Matrix3d inverse = sums_.inverse();
    const Eigen::Matrix3d covariance = product(inverse, spread_, inverse); // the inverse is symmetric
    return covariance.allFinite() ? std::optional<Eigen::Matrix3d>(covariance) : std::nullopt;
}

} // namespace vectorlib
