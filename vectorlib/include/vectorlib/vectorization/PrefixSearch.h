#pragma once

#include "vectorlib/simd/Simd.h"
#include "vectorlib/vectorization/BlockSums.h"
#include "vectorlib/vectorization/Cut.h"
#include "vectorlib/vectorization/PrefixSums.h"

namespace vectorlib {

/// The longest intervals that fit, over prefix sums; thesis 6.3.2, figure 6.5. Two points always fit, so the
/// search cannot fail. The binary search of the thesis is for large clusters only: in small ones it would
/// miss longer intervals that fit though shorter ones do not, and find other lines than BlockSearch.
template <typename Scalar>
class PrefixSearch {
public:
    simd::Level level = simd::Level::Scalar; ///< not used

    /// Takes the points of a cluster, and the variance that is permitted; m^2.
    void assign(PointSpan<Scalar> points, double variance) {
        sums_.assign(points);
        count_ = points.size();
        variance_ = variance;
    }
    const PrefixSums &sums() const { return sums_; }
    Vector2D<double> origin() const { return sums_.origin(); }
    /// The cut before a point.
    Cut at(std::size_t index) const { return {index, sums_.row(index)}; }
    /// Whether the points between two cuts lie within the variance of their line.
    bool fits(const Cut &first, const Cut &end) const {
        return end.index <= first.index + 2 || sums_.fitWithin(first.index, end.index, variance_);
    }

    /// The end of the longest interval that begins at `first`, and the begin of the longest that ends before
    /// `end`; reversed points give reversed intervals.
    void findEnds(const Cut &first, const Cut &end, Cut &ahead, Cut &back) const {
        ahead = at(first.index + longest(count_ - first.index, [&](std::size_t n) {
                       return sums_.fitWithin(first.index, first.index + n, variance_);
                   }));
        back = at(end.index - longest(end.index, [&](std::size_t n) {
                      return sums_.fitWithin(end.index - n, end.index, variance_);
                  }));
    }

private:
    // The points of the longest interval, of `most`: eight numbers at a time, until none of eight fits; in
    // large clusters from where a binary search ends.
    template <typename Fits>
    std::size_t longest(std::size_t most, Fits fits) const {
        std::size_t good = std::min<std::size_t>(2, most), bad = most + 1;
        if (count_ > BlockSums::smallCluster)
            for (std::size_t n = most; bad - good > 1; n = good + (bad - good) / 2)
                (fits(n) ? good : bad) = n;
        for (std::size_t n = good + 1; n <= most && n <= (good + 7) / 8 * 8 + 8; ++n)
            if (fits(n))
                good = n;
        return good;
    }

    PrefixSums sums_;
    std::size_t count_ = 0;
    double variance_ = 0;
};

} // namespace vectorlib
