#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/observation/Discrepancy.h"
#include "vectorlib/tls/TlsFit.h"

#include <Eigen/LU>
#include <cstdint>
#include <optional>
#include <vector>

namespace vectorlib {

/// Why a solution is not accepted; the first of its faults in this order.
enum class Fault {
    None,         ///< the solution is accepted
    Reliability,  ///< the directions of its pairs are too much alike to fix the place
    Ambiguity,    ///< its pairs contradict each other
    MatchedShare, ///< too little of the dynamic set has partners
    NoEvidence,   ///< too little of the static set would be seen from there
    Discrepancy,  ///< what would be seen from there differs from what was seen
    NotPermitted  ///< its transformation is not in the permitted set
};

/// The fault in words, for people.
const char *describe(Fault fault);

/// A set of correspondences, its transformation and what speaks for it.
struct Solution {
    Transformation2D pose; ///< moves the dynamic set onto the static one
    std::vector<CorrespondencePair> pairs;
    double reliability = 0;  ///< in [0, 1], of the pairs' directions
    double ambiguity = 0;    ///< mean energy (7.44) of a pair, weighted by length; m^2
    double matchedShare = 0; ///< of the length of the dynamic set that has partners, in [0, 1]
    ViewComparison view;     ///< of the expected view and the dynamic set
    double score = 0;        ///< in [0, 1]; solutions are ranked by it
    bool accepted = false;
    Fault fault = Fault::None; ///< None exactly when accepted
};

/// How a search ended.
enum class SearchOutcome {
    Complete,     ///< every combination was considered
    Cut,          ///< a bound ended the search: there may be better solutions
    BadSettings,  ///< a setting or the expected transformation is not finite, negative or 0 where it must not
    NothingFixed, ///< no usable segment of the static set is within reach
    NothingMoving,   ///< no usable segment in the dynamic set
    NoPotentialPair, ///< no permitted transformation brings any two segments together
    TooManyPairs,    ///< more pairs near each other than the bounds of the settings
    OneDirection,    ///< all potential pairs are parallel: the shift along them is not known
    NoCombination    ///< no two directions agree on a transformation
};

/// The outcome in words, for people.
const char *describe(SearchOutcome outcome);

/// The solutions of a search, and the work that it took.
struct SearchResult {
    std::vector<Solution> solutions; ///< accepted ones first, then by score
    SearchOutcome outcome = SearchOutcome::Complete;
    std::size_t potentialPairs = 0;
    std::size_t bundles = 0;
    std::size_t buckets = 0;
    std::uint64_t combinations = 0; ///< bundles tried
};

/// Segments and how sure their lines are, one covariance a segment, in one frame.
struct MeasuredSegments {
    std::vector<LineSegment2D<double>> segments;
    std::vector<LineCovariance> lines;
};

/// How sure the pose of a solution is, from how sure its lines are: first order, for lines whose errors are
/// independent and small. The pose is where the points of the dynamic segments lie on the static lines best
/// (PairSelection); it is this estimate that is differentiated, where RegistrationCovariance does the same
/// for the one-step registration.
class SolutionCovariance {
public:
    /// Rows and columns x, y (metres), alpha (radians), in the static frame. Nothing where all lines are
    /// parallel, where a covariance is not valid, and for pairs that are not among the segments.
    std::optional<Eigen::Matrix3d> operator()(const Solution &solution, const MeasuredSegments &fixed,
                                              const MeasuredSegments &moving) const;

private:
    /// What the angle and the offset p of the lines of a pair add to the right side of the normal equations.
    struct Effect {
        Eigen::Matrix<double, 3, 2> byFixed, byMoving;
    };

    template <typename T>
    static const T &at(const std::vector<T> &list, int i);
    static bool isKnown(int i, const MeasuredSegments &set) {
        return i >= 0 && static_cast<std::size_t>(i) < std::min(set.segments.size(), set.lines.size()) &&
               at(set.lines, i).valid;
    }

    // Over the points of the dynamic segment, s metres from its middle, the residual across the static line
    // changes with the pose by j + s k, and with a line's angle and offset by u + s and 1, where u is the
    // place of the middle along the line. The integrals of 1, s, s^2 are L, 0, L^3 / 12.
    static Effect effectOf(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving,
                           const Transformation2D &pose, Eigen::Matrix3d &sums);
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/SearchResult.cpp")
