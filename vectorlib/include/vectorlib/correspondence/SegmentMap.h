#pragma once

#include "vectorlib/geometry/SegmentGrid.h"

namespace vectorlib {

/// Static segments with a spatial index, so that the cost of a search follows its region and not the map.
class SegmentMap {
public:
    /// Adds a segment; returns its number. One that is not finite gets a number and is never found.
    int add(const LineSegment2D<double> &segment) {
        const int number = static_cast<int>(segments_.size());
        segments_.push_back(segment);
        if (segment.isFinite() && segment.length() <= longest)
            grid_.insert(number, segment);
        else if (segment.isFinite())
            long_.push_back(number);
        return number;
    }
    std::size_t size() const { return segments_.size(); }
    const LineSegment2D<double> &operator[](int number) const {
        return segments_[static_cast<std::size_t>(number)];
    }
    /// Numbers of the segments near a square of the given half side, in order, and perhaps of some more;
    /// valid until the next call. None for what is not finite.
    const std::vector<int> &near(Vector2D<double> middle, double reach) {
        found_.clear();
        if (!middle.isFinite() || !(reach >= 0))
            return found_;
        const Vector2D<double> half(reach, reach);
        if (reach * reach > cell * cell * (1 + double(segments_.size()))) // fewer segments than cells
            for (std::size_t i = 0; i < segments_.size(); ++i)
                found_.push_back(static_cast<int>(i));
        else {
            found_ = long_;
            grid_.query(middle - half, middle + half, [this](int number) { found_.push_back(number); });
            std::sort(found_.begin(), found_.end());
        }
        return found_;
    }

private:
    static constexpr double cell = 2;       // metres
    static constexpr double longest = 2000; // metres; longer segments are in too many cells

    std::vector<LineSegment2D<double>> segments_;
    SegmentGrid grid_{cell};
    std::vector<int> long_;
    std::vector<int> found_;
};

} // namespace vectorlib
