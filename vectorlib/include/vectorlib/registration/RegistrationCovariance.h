#pragma once

#include "vectorlib/geometry/SmallMatrix.h"
#include "vectorlib/registration/LineSegmentRegistration.h"
#include "vectorlib/tls/LineCovariance.h"

#include <Eigen/LU>

#include <optional>

namespace vectorlib {

/// How sure the result of a registration is, from how sure its lines are: first order, for lines whose errors
/// are independent and small. Paper (5), (1) and erratum 6 differentiated by the angle and the offset p = B.n
/// of every line; the terms that are as small as the disagreement of the pairs are left out.
///
/// Make it with the registration of all pairs, add the same pairs with the covariances of their lines, then
/// ask.
class RegistrationCovariance {
public:
    explicit RegistrationCovariance(const LineSegmentRegistration &registration)
        : translation_(registration.transformation().translation())
        , solvable_(registration.isSolvable()) {}

    /// False (and from then on no covariance) when the pair is not usable or a covariance is not valid.
    bool add(const SegmentPair &pair, const LineCovariance &fixed, const LineCovariance &moving) {
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

    /// Rows and columns x, y (metres), alpha (radians). Nothing without pairs, where all lines are parallel
    /// (the shift along them is not known at all), and where a covariance was missing.
    std::optional<Eigen::Matrix3d> operator()() const {
        if (!solvable_)
            return std::nullopt;
        const Eigen::Matrix3d inverse = sums_.inverse();
        const Eigen::Matrix3d covariance = product(inverse, spread_, inverse); // the inverse is symmetric
        return covariance.allFinite() ? std::optional<Eigen::Matrix3d>(covariance) : std::nullopt;
    }

private:
    Vector2D<double> translation_;
    bool solvable_;
    Eigen::Matrix3d spread_ = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d sums_ = Eigen::Matrix3d::Zero();
};

} // namespace vectorlib
