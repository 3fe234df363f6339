#pragma once

#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/simd/Simd.h"
#include "vectorlib/vectorization/BlockSums.h"
#include "vectorlib/vectorization/VectorizedLine.h"

#include <vector>

namespace vectorlib {

/// The augmented matrix A of thesis (6.23), (6.24), shifted by the first point (erratum 3): the sums of any
/// interval of points in constant time.
class PrefixSums {
public:
    /// Takes the points of a cluster.
    template <typename Scalar>
    void assign(PointSpan<Scalar> points) {
        rows_.resize(points.size() + 1);
        rows_[0] = SumRow{};
        if (points.empty())
            return;
        origin_ = Vector2D<double>(points.front());
        SumRow sum{};
        for (std::size_t i = 0; i < points.size(); ++i) {
            sum.add(points[i].x - origin_.x, points[i].y - origin_.y);
            rows_[i + 1] = sum;
        }
    }
    /// The sums before point i, relative to the first point.
    const SumRow &row(std::size_t i) const { return rows_[i]; }
    /// The same cut at another place.
    Cut moved(const Cut &, std::size_t to) const { return {to, rows_[to]}; }
    Vector2D<double> origin() const { return origin_; }
    /// How many points there are between two rows.
    static constexpr std::size_t stride() { return 1; }

    /// The sums of points first .. end - 1; end > first.
    TlsSums sums(std::size_t first, std::size_t end) const {
        const SumRow &a = rows_[first], &b = rows_[end];
        return TlsSums::fromPlain(static_cast<double>(end - first), b.x - a.x, b.y - a.y, b.xx - a.xx,
                                  b.xy - a.xy, b.yy - a.yy, origin_);
    }

    /// Whether points first .. end - 1 lie within the root of `variance` of their line.
    bool fitWithin(std::size_t first, std::size_t end, double variance) const {
        return ThresholdTest(static_cast<double>(end - first), rows_[end] - rows_[first], variance, 0, 0)
            .fits();
    }

private:
    std::vector<SumRow> rows_; // rows_[i] sums the points before i
    Vector2D<double> origin_;
};

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
