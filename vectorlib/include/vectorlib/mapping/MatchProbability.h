#pragma once

#include "vectorlib/mapping/GlobalPairMatch.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

/// How probable it is that each solution of a match without estimate is right: within 10 cm and 2 degrees of
/// corrected poses, whose own errors count as those of the match. A logistic function of how well the best
/// solution agrees tells whether the right one is among them, and powers of their scores divide that among
/// them: where two fit alike, each has half.
struct MatchProbability {
    // Fitted to the pairs of one half of five logs; docs/algorithms.md has the command.
    double constant = -2.28, slideLoss = 5.82, logLength = 1.14;
    double sharpness = 64; ///< of the score among solutions

    void operator()(GlobalPairMatch &match) const {
        if (match.solutions.empty())
            return;
        const GlobalPairSolution &best = match.solutions[0];
        const SurfaceAgreement &a = best.agreement;
        const double sum = constant + slideLoss * std::clamp(match.slideLoss, -0.1, 0.4) +
                           logLength * std::log(std::max(0.3, a.explained() * a.length()));
        const double any = 1 / (1 + std::exp(-sum));
        double total = 0;
        for (GlobalPairSolution &s : match.solutions)
            total += s.probability = std::exp(sharpness * (s.score - best.score));
        for (GlobalPairSolution &s : match.solutions)
            s.probability *= any / total;
    }
};

} // namespace vectorlib
