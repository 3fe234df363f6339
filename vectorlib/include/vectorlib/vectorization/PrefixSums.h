#pragma once

#include "vectorlib/geometry/PointSpan.h"
#include "vectorlib/vectorization/Cut.h"

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

} // namespace vectorlib
