#include "vectorlib/mapping/MatchProbability.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY MatchProbability::Features MatchProbability::features(const GlobalPairMatch &match) {
    const SurfaceAgreement &a = match.solutions[0].agreement;
    const double judged = a.explained() + a.contradicted();
    return {1, judged > 0 ? a.contradicted() / judged : 1, std::clamp(match.slideLoss, -0.1, 0.25),
            std::log(std::max(0.3, a.explained() * a.length())), a.score()};
}

VECTORLIB_BODY double MatchProbability::ofAny(const Features &f) const {
    double sum = 0;
    for (std::size_t i = 0; i < f.size(); ++i)
        sum += weights[i] * f[i];
    return ceiling / (1 + std::exp(-sum));
}

VECTORLIB_BODY void MatchProbability::operator()(GlobalPairMatch &match) const {
    if (match.solutions.empty())
        return;
    const double any = ofAny(features(match));
    double total = 0, best = -1;
    for (const GlobalPairSolution &s : match.solutions)
        best = std::max(best, fit(s));
    for (GlobalPairSolution &s : match.solutions)
        total += s.probability = std::exp(sharpness * (fit(s) - best));
    for (GlobalPairSolution &s : match.solutions)
        s.probability *= any / total;
}

} // namespace vectorlib
