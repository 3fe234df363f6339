#pragma once

#include "vectorlib/mapping/GlobalPairMatch.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vectorlib {

/// How probable it is that a solution of a match without estimate is right: within 10 cm and 2 degrees of
/// corrected poses, whose own errors count as those of the match. A logistic function of how well the best
/// solution agrees tells whether the right one is among them, and powers of their consistency divide that
/// among them: of two that fit alike each has half. It takes for granted that the scans show the same place.
struct MatchProbability {
    using Features = std::array<double, 4>;

    /// Of the features, and how much a difference of consistency tells. Fitted to the first half of the pairs
    /// of five logs, neighbouring scans and ones farther apart, by hermes-vector experiment calibration
    /// --half 1 --log intel... (docs/algorithms.md has all of it).
    Features weights{-2.65, -10.14, 5.08, 1.38};
    double sharpness = 31;

    /// What tells whether the right solution is among those of a match that has some: a constant 1, the share
    /// of surfaces that the best contradicts, what it loses by sliding, and the logarithm of how many metres
    /// of surface it explains.
    static Features features(const GlobalPairMatch &match) {
        const SurfaceAgreement &a = match.solutions[0].agreement;
        return {1, a.contradicted(), std::clamp(match.slideLoss, -0.1, 0.4),
                std::log(std::max(0.3, a.explained() * a.length()))};
    }
    void operator()(GlobalPairMatch &match) const {
        if (match.solutions.empty())
            return;
        const Features f = features(match);
        const double best = match.solutions[0].agreement.consistency();
        double sum = 0, total = 0;
        for (std::size_t i = 0; i < f.size(); ++i)
            sum += weights[i] * f[i];
        const double any = 1 / (1 + std::exp(-sum));
        for (GlobalPairSolution &s : match.solutions)
            total += s.probability = std::exp(sharpness * (s.agreement.consistency() - best));
        for (GlobalPairSolution &s : match.solutions)
            s.probability *= any / total;
    }
};

} // namespace vectorlib
