#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/similarity/EdgeSetComparator.h"

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
    CriterionMinimum operator()(const EdgeSetComparator &criterion, const Transformation2D &start) const;

private:
    /// Metres that make translation and rotation comparable: a turn bends the criterion as much as this
    /// shift.
    static double leverOf(const Eigen::Matrix3d &hessian);
    /// The Newton step with its safeguards, in metres and radians.
    static Eigen::Vector3d direction(const CriterionExpansion &e, double lever);
    /// Goes along delta to where the criterion is less; false when no step worth it helps.
    bool descend(const EdgeSetComparator &criterion, Eigen::Vector3d delta, double lever,
                 CriterionMinimum &best) const;
    /// Near the minimum the criterion is all rounding, but its gradient is not: takes the last small step
    /// when the gradient falls.
    static void polish(const EdgeSetComparator &criterion, const CriterionExpansion &e,
                       const Eigen::Vector3d &delta, double lever, CriterionMinimum &best);
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/similarity/CriterionMinimizer.cpp")
