#include "vectorlib/relations/RelationScan.h"
#include "vectorlib/geometry/LineSegment2D.h"

namespace vectorlib {

VECTORLIB_BODY double SeenThrough::standingIn(const std::vector<TypedSegment> &seen,
                                              const std::vector<TypedSegment> &others,
                                              const Transformation2D &pose) const {
    double length = 0;
    for (const TypedSegment &o : others) {
        const LineSegment2D<double> s = pose * o.segment;
        for (int i = 0; i < samples; ++i) {
            const Vector2D<double> p = s.begin() + (s.end() - s.begin()) * ((i + 0.5) / samples);
            if (isInFront(seen, p))
                length += s.length() / samples;
        }
    }
    return length;
}

VECTORLIB_BODY bool SeenThrough::isInFront(const std::vector<TypedSegment> &seen, Vector2D<double> p) const {
    return std::any_of(seen.begin(), seen.end(), [&](const TypedSegment &t) {
        const LineSegment2D<double> &s = t.segment;
        return s.begin().cross(p) > 0 && p.cross(s.end()) > 0 && s.across(p) > margin;
    });
}

VECTORLIB_BODY void RelationScan::build(const std::vector<TypedSegment> &all,
                                        const RelationSettings &settings) {
    chooseUsable(all);
    keepLongest(all, settings.maxSegments);
    segments_.clear();
    for (std::size_t k = 0; k < numbers_.size(); ++k) {
        segments_.push_back(all[numbers_[k]]);
        // A neighbour that is left out takes the angle edge with it.
        TypedSegment &s = segments_.back();
        s.joined = s.joined && k + 1 < numbers_.size() && numbers_[k + 1] == numbers_[k] + 1 &&
                   (s.segment.end() - all[numbers_[k + 1]].segment.begin()).norm() < meeting;
    }
    leftOut_ = all.size() - numbers_.size();
    relations_.build(segments_, settings);
}

VECTORLIB_BODY void RelationScan::chooseUsable(const std::vector<TypedSegment> &all) {
    numbers_.clear();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const LineSegment2D<double> &s = all[i].segment;
        if (isUsable(s) && isWithinReach(s.begin()) && isWithinReach(s.end()) && s.length() > 1e-6)
            numbers_.push_back(i);
    }
}

VECTORLIB_BODY void RelationScan::keepLongest(const std::vector<TypedSegment> &all, std::size_t most) {
    if (numbers_.size() <= most)
        return;
    std::nth_element(numbers_.begin(), numbers_.begin() + std::ptrdiff_t(most), numbers_.end(),
                     [&](std::size_t a, std::size_t b) {
                         const double la = all[a].segment.length(), lb = all[b].segment.length();
                         return la != lb ? la > lb : a < b;
                     });
    numbers_.resize(most);
    std::sort(numbers_.begin(), numbers_.end());
}

} // namespace vectorlib
