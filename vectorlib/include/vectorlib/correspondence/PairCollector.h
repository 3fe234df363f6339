#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/NearLines.h"
#include "vectorlib/correspondence/PotentialPair.h"
#include "vectorlib/correspondence/SearchSettings.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Vector2D.h"

#include <vector>

namespace vectorlib {

/// Collects all pairs that may correspond (thesis 7.4.1, first stage) without looking at what is far apart.
/// Keeps its buffers.
class PairCollector {
public:
    using Segments = std::vector<LineSegment2D<double>>;

    /// Both sets in the expected sensor frame, finite and of some length. False where `maxPairs` or
    /// `maxCompared` of the settings ended it.
    bool operator()(const Segments &fixed, const Segments &moving, const SearchSettings &settings,
                    std::vector<PotentialPair> &pairs);

private:
    NearLines lines_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/PairCollector.cpp")
