#include "vectorlib/similarity/HausdorffDistances.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vectorlib {

VECTORLIB_BODY double hausdorffDistance(const LineSegment2D<double> &p, const LineSegment2D<double> &q) {
    if (!isUsable(p) || !isUsable(q))
        return std::numeric_limits<double>::quiet_NaN();
    return std::max({p.distance(q.begin()), p.distance(q.end()), q.distance(p.begin()), q.distance(p.end())});
}

VECTORLIB_BODY double modifiedHausdorffDistance(const LineSegment2D<double> &p,
                                                const LineSegment2D<double> &q) {
    if (!isUsable(p) || !isUsable(q))
        return std::numeric_limits<double>::quiet_NaN();
    return std::min(p.length(), q.length()) * std::abs(p.direction().cross(q.direction()));
}

VECTORLIB_BODY double perpendicularHausdorffDistance(const LineSegment2D<double> &p,
                                                     const LineSegment2D<double> &q) {
    if (!isUsable(p) || !isUsable(q))
        return std::numeric_limits<double>::quiet_NaN();
    const double qBegin = std::abs(p.across(q.begin())), qEnd = std::abs(p.across(q.end()));
    const double pBegin = std::abs(q.across(p.begin())), pEnd = std::abs(q.across(p.end()));
    const double d1 = std::min(std::max(qBegin, qEnd), std::max(pBegin, pEnd));
    const double d2 = std::min(std::min(qBegin, qEnd), std::min(pBegin, pEnd));
    const double sum = d1 + d2;
    return sum > 0 ? d1 * (d1 / sum) + d2 * (d2 / sum) : 0;
}

} // namespace vectorlib
