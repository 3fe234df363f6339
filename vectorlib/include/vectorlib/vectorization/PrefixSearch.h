#pragma once

#include "vectorlib/simd/Simd.h"
#include "vectorlib/vectorization/Cut.h"
#include "vectorlib/vectorization/PrefixSums.h"

namespace vectorlib {

/// The longest intervals that fit, by binary search over prefix sums; thesis 6.3.2, figure 6.5. Two points
/// always fit, so the search cannot fail.
template <typename Scalar>
class PrefixSearch {
public:
    simd::Level level = simd::Level::Scalar; ///< not used

    void assign(PointSpan<Scalar> points, double variance) {
        sums_.assign(points);
        count_ = points.size();
        variance_ = variance;
    }
    const PrefixSums &sums() const { return sums_; }
    Vector2D<double> origin() const { return sums_.origin(); }
    Cut at(std::size_t index) const { return {index, sums_.row(index)}; }
    bool fits(const Cut &first, const Cut &end) const {
        return end.index <= first.index + 2 || sums_.fitWithin(first.index, end.index, variance_);
    }

    /// The end of the longest interval that begins at `first`, and the begin of the longest that ends before
    /// `end`; reversed points give reversed intervals.
    void findEnds(const Cut &first, const Cut &end, Cut &ahead, Cut &back) const {
        ahead = endFrom(first);
        back = beginFrom(end);
    }

private:
    Cut endFrom(const Cut &first) const {
        std::size_t good = std::min(first.index + 2, count_), bad = count_ + 1;
        for (std::size_t next = count_; bad - good > 1; next = good + (bad - good) / 2)
            (sums_.fitWithin(first.index, next, variance_) ? good : bad) = next;
        return at(good);
    }
    Cut beginFrom(const Cut &end) const {
        std::size_t good = std::min<std::size_t>(2, end.index), bad = end.index + 1; // points
        for (std::size_t next = end.index; bad - good > 1; next = good + (bad - good) / 2)
            (sums_.fitWithin(end.index - next, end.index, variance_) ? good : bad) = next;
        return at(end.index - good);
    }

    PrefixSums sums_;
    std::size_t count_ = 0;
    double variance_ = 0;
};

} // namespace vectorlib
