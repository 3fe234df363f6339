#include "vectorlib/mapping/PoseTrust.h"

#include <cmath>

namespace vectorlib {

VECTORLIB_BODY PoseTrust::Features PoseTrust::features(const Match &match, const Transformation2D &expected,
                                                       double finalDistance) {
    const Transformation2D off = expected.inverse() * match.pose;
    const double far = off.translation().norm() + 0.5 * std::abs(off.alpha());
    return {1,
            within(match.reliability),
            within(match.rms / finalDistance),
            std::log(double(std::max<std::size_t>(1, match.pairs.size()))),
            std::log(0.01 + within(far)),
            within(match.matchedLength / match.visibleLength)};
}

VECTORLIB_BODY double PoseTrust::operator()(const Features &f) const {
    double sum = 0;
    for (std::size_t i = 0; i < f.size(); ++i)
        sum += weights[i] * f[i];
    const double p = 1 / (1 + std::exp(-sum));
    return p > 0 ? p : 0; // no number: nothing is known
}

} // namespace vectorlib
