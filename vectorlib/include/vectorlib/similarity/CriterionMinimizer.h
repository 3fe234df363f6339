#pragma once

#include "vectorlib/similarity/EdgeSetComparator.h"

#include <Eigen/Eigenvalues>

namespace vectorlib {

/// What a search for the least criterion found.
struct CriterionMinimum {
    Transformation2D transformation; ///< moves the dynamic set onto the static one
    double criterion = 0;            ///< there; m^4
    int iterations = 0;              ///< that were made
    bool converged = false;          ///< false when the iterations ended before the steps had become nothing
};

/// Finds the minimum of EdgeSetComparator that is downhill from a start, by Newton's method. The safeguards:
/// a direction in which the criterion bends down is searched the other way, one in which it is flat (along
/// parallel lines) is left alone, a turn is at most one radian, and a step is halved until the criterion
/// falls.
///
/// The criterion does not know which way segments run: turned by pi it may have another minimum. A start
/// within a right angle of the truth, like that of LineSegmentRegistration, avoids it.
class CriterionMinimizer {
public:
    int iterations = 50; ///< at most
    double step =
        1e-11; ///< metres, and for a turn at the segments' mean distance: smaller ones end the search

    /// Searches from `start`; both move the dynamic set. A start that is not finite comes back as it is.
    CriterionMinimum operator()(const EdgeSetComparator &criterion, const Transformation2D &start) const {
        CriterionMinimum best;
        best.transformation = start;
        best.criterion = criterion(start);
        if (!start.isFinite())
            return best;
        while (best.iterations < iterations && !best.converged) {
            ++best.iterations;
            const CriterionExpansion e = criterion.expansion(best.transformation);
            const double lever = leverOf(e.hessian);
            Eigen::Vector3d delta = direction(e, lever);
            delta /= std::max(1.0, std::abs(delta(2)));
            best.converged = !descend(criterion, delta, lever, best);
            if (best.converged)
                polish(criterion, e, delta, lever, best);
        }
        return best;
    }

private:
    /// Metres that make translation and rotation comparable: a turn bends the criterion as much as this
    /// shift.
    static double leverOf(const Eigen::Matrix3d &hessian) {
        const double shift = hessian(0, 0) + hessian(1, 1), turn = std::abs(hessian(2, 2));
        return shift > 0 && turn > 0 ? std::sqrt(turn / shift) : 1;
    }
    /// The Newton step with its safeguards, in metres and radians.
    static Eigen::Vector3d direction(const CriterionExpansion &e, double lever) {
        constexpr double flat = 1e-10; // relative curvature that is rounding
        const Eigen::Vector3d scale(1, 1, 1 / lever);
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scale.asDiagonal() * e.hessian *
                                                                   scale.asDiagonal());
        const double largest = eigen.eigenvalues().cwiseAbs().maxCoeff();
        Eigen::Vector3d delta = Eigen::Vector3d::Zero();
        for (int i = 0; i < 3; ++i) {
            const double curvature = std::abs(eigen.eigenvalues()(i));
            const Eigen::Vector3d axis = scale.asDiagonal() * eigen.eigenvectors().col(i);
            if (curvature > flat * largest)
                delta -= axis * (axis.dot(e.gradient) / curvature);
        }
        return delta;
    }
    /// Goes along delta to where the criterion is less; false when no step worth it helps.
    bool descend(const EdgeSetComparator &criterion, Eigen::Vector3d delta, double lever,
                 CriterionMinimum &best) const {
        const Transformation2D from = best.transformation;
        for (; std::hypot(delta(0), delta(1), delta(2) * lever) > step; delta /= 2) {
            const Transformation2D to(from.x() + delta(0), from.y() + delta(1), from.alpha() + delta(2));
            const double value = criterion(to);
            if (value < best.criterion) {
                best.transformation = to;
                best.criterion = value;
                return true;
            }
        }
        return false;
    }
    /// Near the minimum the criterion is all rounding, but its gradient is not: takes the last small step
    /// when the gradient falls.
    static void polish(const EdgeSetComparator &criterion, const CriterionExpansion &e,
                       const Eigen::Vector3d &delta, double lever, CriterionMinimum &best) {
        constexpr double small = 1e-5; // metres
        const Eigen::Vector3d scale(1, 1, 1 / lever);
        const Transformation2D &from = best.transformation;
        const Transformation2D to(from.x() + delta(0), from.y() + delta(1), from.alpha() + delta(2));
        const CriterionExpansion there = criterion.expansion(to);
        if (delta.cwiseQuotient(scale).norm() < small &&
            there.gradient.cwiseProduct(scale).norm() < e.gradient.cwiseProduct(scale).norm()) {
            best.transformation = to;
            best.criterion = there.value;
        }
    }
};

} // namespace vectorlib
