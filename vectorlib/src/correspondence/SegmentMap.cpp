#include "vectorlib/correspondence/SegmentMap.h"

namespace vectorlib {

VECTORLIB_BODY int SegmentMap::add(const LineSegment2D<double> &segment) {
    const int number = static_cast<int>(segments_.size());
    segments_.push_back(segment);
    if (segment.isFinite() && segment.length() <= longest)
        grid_.insert(number, segment);
    else if (segment.isFinite())
        long_.push_back(number);
    return number;
}

VECTORLIB_BODY const std::vector<int> &SegmentMap::near(Vector2D<double> middle, double reach) {
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

} // namespace vectorlib
