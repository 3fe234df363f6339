#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/relations/RelationSet.h"
#include "vectorlib/relations/RelationSettings.h"
#include "vectorlib/relations/TypedSegment.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vectorlib {

/// The segments of a scan that take part in a match, with their relations. Left out are those that are not
/// finite, lie beyond 1000 km or have no length, and of more than the bound all but the longest; the order
/// stays. An angle edge with the next segment counts only where the two meet: in a set out of order they do
/// not. Memory for n segments: n numbers, and what the bound needs. Keeps its buffers.
class RelationScan {
public:
    /// Takes the segments of a scan in their order.
    void build(const std::vector<TypedSegment> &all, const RelationSettings &settings);
    const std::vector<TypedSegment> &segments() const { return segments_; }
    const RelationSet &relations() const { return relations_; }
    std::size_t leftOut() const { return leftOut_; }
    /// The number of a segment as it was given.
    int given(int number) const { return static_cast<int>(numbers_[static_cast<std::size_t>(number)]); }

private:
    static constexpr double meeting = 0.01; // between ends that are one angle edge; metres

    static bool isWithinReach(Vector2D<double> p) { return std::max(std::abs(p.x), std::abs(p.y)) < 1e6; }

    void chooseUsable(const std::vector<TypedSegment> &all);
    void keepLongest(const std::vector<TypedSegment> &all, std::size_t most);

    std::vector<std::size_t> numbers_;
    std::vector<TypedSegment> segments_;
    RelationSet relations_;
    std::size_t leftOut_ = 0;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/RelationScan.cpp")
