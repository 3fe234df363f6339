#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/SegmentGrid.h"
#include "vectorlib/geometry/Vector2D.h"

#include <vector>

namespace vectorlib {

/// Static segments with a spatial index, so that the cost of a search follows its region and not the map.
class SegmentMap {
public:
    /// Adds a segment; returns its number. One that is not finite gets a number and is never found.
    int add(const LineSegment2D<double> &segment);
    std::size_t size() const { return segments_.size(); }
    const LineSegment2D<double> &operator[](int number) const {
        return segments_[static_cast<std::size_t>(number)];
    }
    /// Numbers of the segments near a square of the given half side, in order, and perhaps of some more;
    /// valid until the next call. None for what is not finite.
    const std::vector<int> &near(Vector2D<double> middle, double reach);

private:
    static constexpr double cell = 2;       // metres
    static constexpr double longest = 2000; // metres; longer segments are in too many cells

    std::vector<LineSegment2D<double>> segments_;
    SegmentGrid grid_{cell};
    std::vector<int> long_;
    std::vector<int> found_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/SegmentMap.cpp")
