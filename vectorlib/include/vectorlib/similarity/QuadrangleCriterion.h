#pragma once

#include "vectorlib/geometry/SegmentPair.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <algorithm>
#include <vector>

namespace vectorlib {

/// The area between two segments that the older criterion takes (overview paper 2.2, figure 3); m^2. Seen
/// along the axis that halves the angle between the two lines, the quadrangle reaches from the first of the
/// four end points to the last (the largest of the six), between the lines; where they cross inside it, both
/// triangles count.
inline double quadrangleArea(const LineSegment2D<double> &p, const LineSegment2D<double> &q) {
    const Vector2D<double> d = p.direction(), e = d.dot(q.direction()) < 0 ? -q.direction() : q.direction();
    const Vector2D<double> axis = (d + e).normalized(); // at most 45 degrees from both
    const double slope = axis.cross(d) / axis.dot(d);   // of p over the axis; that of q is the opposite
    const Vector2D<double> origin = p.middle();
    double first = 0, last = 0; // p's middle lies between its ends
    for (const Vector2D<double> &end : {p.begin(), p.end(), q.begin(), q.end()}) {
        first = std::min(first, axis.dot(end - origin));
        last = std::max(last, axis.dot(end - origin));
    }
    const Vector2D<double> other = q.middle() - origin;
    const double gap = axis.cross(other) + slope * axis.dot(other); // from p to q at the origin
    const double left = gap - 2 * slope * first, right = gap - 2 * slope * last;
    if (left * right >= 0)
        return std::abs(left + right) / 2 * (last - first);
    return (left * left + right * right) / (2 * std::abs(left - right)) * (last - first);
}

/// The older criterion for a set of pairs: the weighted sum of squared areas; m^4. Every evaluation goes
/// through all pairs, and it is not smooth: the baseline that EdgeSetComparator is measured against.
class QuadrangleCriterion {
public:
    /// False (and nothing added) when the pair is not usable.
    bool add(const SegmentPair &pair) {
        if (!isUsable(pair))
            return false;
        pairs_.push_back(pair);
        return true;
    }
    void clear() { pairs_.clear(); }

    /// 0 without pairs.
    double operator()(const Transformation2D &t) const {
        double sum = 0;
        for (const SegmentPair &pair : pairs_) {
            const double area = quadrangleArea(pair.fixed, t * pair.moving);
            sum += pair.weight * area * area;
        }
        return sum;
    }

private:
    std::vector<SegmentPair> pairs_;
};

} // namespace vectorlib
