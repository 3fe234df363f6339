#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/LineSegmentRegistration.h"
#include "vectorlib/registration/PointRefinement.h"
#include "vectorlib/tls/TlsFit.h"

#include <optional>

namespace vectorlib {

/// The covariance of a pose that PointRefinement found, from what the scans show there: that of an
/// M-estimator, A^-1 B A^-1 (P. Huber, Robust Statistics, 1981, section 6.3). B is the scatter of the sum of
/// the weighted residuals, from these themselves; no noise is assumed. A tells how that sum changes with the
/// pose. It is taken from differences between poses a few centimetres apart, each with pairs of its own: a
/// point near a wall that scatters finds a partner near it at every pose, and so resists a motion less than
/// its residual says.
class PointCovariance {
public:
    /// Standard deviation of a point from its wall, metres. Nothing: it follows from the residuals.
    std::optional<double> noise;

    /// Of x, y (metres, fixed frame) and the rotation about the moving sensor (radians). Scans and settings
    /// are those of the refinement; a sample of the points judges. A direction in which they hold the pose
    /// hardly more than chance would has the gate of the pairs; a pose without pairs has 100 metres and
    /// radians.
    Eigen::Matrix3d operator()(const PointRefinement &refine, const Transformation2D &pose) const;

private:
    static constexpr double farthest = 100;                         // metres, radians
    static constexpr double leastLever = 0.5;                       // metres
    static constexpr double leastStep = 0.005, stepByScatter = 1.6; // metres, by metre of the residuals
    static constexpr int enoughPoints = 500;                        // of both scans together
    static constexpr double leastHold = 0.005;                      // of the weight of all pairs
    static constexpr double leastResidual = 0.001; // to which ranges are told at best; metres

    struct Sums {
        double weight = 0, squares = 0; // of the pairs; squares of their residuals, weighted
        Eigen::Matrix3d information = Eigen::Matrix3d::Zero(); // weighted squares of the derivatives
        Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();     // of the weighted residuals
    };
    struct Term {
        Eigen::Vector3d derivative;
        double residual, weight;
    };
    // Every n-th point takes part.
    static int sampleOf(const PointRefinement &refine) {
        return 1 + (refine.fixed().size() + refine.moving().size()) / enoughPoints;
    }
    // Calls each with the terms of the normal equations at a pose.
    template <typename Each>
    static void forEachTerm(const PointRefinement &refine, const Transformation2D &pose, Each each);
    Sums sumsAt(const PointRefinement &refine, const Transformation2D &pose) const;
    static Eigen::Vector3d pullAt(const PointRefinement &refine, const Transformation2D &pose);
    static Eigen::Matrix3d changeOfPull(const PointRefinement &refine, const Transformation2D &pose,
                                        double step, double turn);
};

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
