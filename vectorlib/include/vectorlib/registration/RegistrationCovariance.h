#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/SegmentPair.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/LineSegmentRegistration.h"
#include "vectorlib/tls/LineCovariance.h"

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
    bool add(const SegmentPair &pair, const LineCovariance &fixed, const LineCovariance &moving);

    /// Rows and columns x, y (metres), alpha (radians). Nothing without pairs, where all lines are parallel
    /// (the shift along them is not known at all), and where a covariance was missing.
    std::optional<Eigen::Matrix3d> operator()() const;

private:
    Vector2D<double> translation_;
    bool solvable_;
    Eigen::Matrix3d spread_ = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d sums_ = Eigen::Matrix3d::Zero();
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/registration/RegistrationCovariance.cpp")
