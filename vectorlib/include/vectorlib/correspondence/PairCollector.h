#pragma once

#include "vectorlib/correspondence/NearLines.h"
#include "vectorlib/correspondence/PotentialPair.h"
#include "vectorlib/correspondence/SearchSettings.h"

namespace vectorlib {

/// Collects all pairs that may correspond (thesis 7.4.1, first stage) without looking at what is far apart.
/// Keeps its buffers.
class PairCollector {
public:
    using Segments = std::vector<LineSegment2D<double>>;

    /// Both sets in the expected sensor frame, finite and of some length. False where `maxPairs` or
    /// `maxCompared` of the settings ended it.
    bool operator()(const Segments &fixed, const Segments &moving, const SearchSettings &settings,
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

private:
    NearLines lines_;
};

} // namespace vectorlib
