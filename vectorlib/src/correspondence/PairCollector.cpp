#include "vectorlib/correspondence/PairCollector.h"

namespace vectorlib {

VECTORLIB_BODY bool PairCollector::operator()(const Segments &fixed, const Segments &moving,
                                              const SearchSettings &settings,
                                              std::vector<PotentialPair> &pairs) {
    pairs.clear();
    const double cosine = std::cos(std::min(pi, settings.permitted.dalpha)) - 1e-9;
    lines_.build(fixed, std::hypot(settings.permitted.dx, settings.permitted.dy));
    std::size_t compared = 0;
    const auto isWithinBounds = [&] {
        return compared <= settings.maxCompared && pairs.size() <= settings.maxPairs;
    };
    for (std::size_t m = 0; m < moving.size() && isWithinBounds(); ++m)
        lines_.query(moving[m], [&](int f) {
            ++compared;
            const LineSegment2D<double> &line = fixed[static_cast<std::size_t>(f)];
            if (line.direction().dot(moving[m].direction()) >= cosine && // most end here
                mayCorrespond(line, moving[m], settings.permitted))
                pairs.emplace_back(CorrespondencePair{f, static_cast<int>(m)}, line, moving[m],
                                   settings.stiffness);
            return isWithinBounds();
        });
    return isWithinBounds();
}

} // namespace vectorlib
