#pragma once

#include "vectorlib/geometry/PointSpan.h"
#include "vectorlib/tls/TlsSums.h"

#include <vector>

namespace vectorlib {

/// The augmented matrix A of thesis (6.23), (6.24), shifted by the first point (erratum 3): the sums of any
/// interval of points in constant time.
class PrefixSums {
public:
    template <typename Scalar>
    void assign(PointSpan<Scalar> points) {
        rows_.resize(points.size() + 1);
        rows_[0] = Row();
        if (points.empty())
            return;
        origin_ = Vector2D<double>(points.front());
        Row sum;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double x = points[i].x - origin_.x, y = points[i].y - origin_.y;
            sum.x += x;
            sum.y += y;
            sum.xx += x * x;
            sum.xy += x * y;
            sum.yy += y * y;
            rows_[i + 1] = sum;
        }
    }

    /// The sums of points first .. end - 1; end > first.
    TlsSums sums(std::size_t first, std::size_t end) const {
        const Row &a = rows_[first], &b = rows_[end];
        return TlsSums::fromPlain(static_cast<double>(end - first), b.x - a.x, b.y - a.y, b.xx - a.xx,
                                  b.xy - a.xy, b.yy - a.yy, origin_);
    }

    /// Whether points first .. end - 1 lie within sigma of their line; like fitsWithin(), but multiplied
    /// through by the count, so that the search makes no division.
    bool fitWithin(std::size_t first, std::size_t end, double variance) const {
        const Row &a = rows_[first], &b = rows_[end];
        const double n = static_cast<double>(end - first), x = b.x - a.x, y = b.y - a.y;
        const double limit = n * n * variance;
        const double xx = n * (b.xx - a.xx) - x * x - limit;
        const double yy = n * (b.yy - a.yy) - y * y - limit;
        const double xy = n * (b.xy - a.xy) - x * y;
        return !(xx > 0 && yy > 0 && xx * yy > xy * xy);
    }

private:
    struct Row {
        double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    };
    std::vector<Row> rows_; // rows_[i] sums the points before i
    Vector2D<double> origin_;
};

} // namespace vectorlib
