#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/mapping/GlobalPairMatch.h"

#include <array>

namespace vectorlib {

/// How probable it is that a solution of a match without estimate is right: within 10 cm and 2 degrees of
/// corrected poses, whose own errors count as those of the match. A logistic function of how well the best
/// solution agrees, up to a ceiling, tells whether the right one is among them; powers of how well each of
/// them fits divide that among them: of two that fit alike each has half. It takes for granted that the scans
/// show the same place.
struct MatchProbability {
    using Features = std::array<double, 5>;

    /// Of the features. With the ceiling and the sharpness fitted to the first half of the
    /// pairs of five logs, neighbouring scans and ones farther apart, by hermes-vector experiment calibration
    /// --half 1 --log intel... (docs/algorithms.md has all of it).
    Features weights{-3.92, -10.99, 12.39, 2.44, -3.19};
    double ceiling = 0.986;  ///< however well two scans agree: corrected poses have errors, too
    double sharpness = 36.7; ///< how much a difference of fit tells

    /// What tells whether the right solution is among those of a match that has some: a constant 1, the part
    /// that the best contradicts of what it explains or contradicts, what it loses by sliding, the logarithm
    /// of how many metres of surface it explains, and its score.
    static Features features(const GlobalPairMatch &match);
    /// Half of it counts what is out of the other scan's sight, half of it hardly does.
    static double fit(const GlobalPairSolution &s) {
        return (s.agreement.score() + s.agreement.consistency()) / 2;
    }
    /// That the right solution is among those of a match with these features.
    double ofAny(const Features &f) const;
    /// Sets the probability of every solution of a match; they add up to at most `ceiling`.
    void operator()(GlobalPairMatch &match) const;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/MatchProbability.cpp")
