#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/SegmentPair.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"

#include <vector>

namespace vectorlib {

/// The area between two segments that the older criterion takes (overview paper 2.2, figure 3); m^2. Seen
/// along the axis that halves the angle between the two lines, the quadrangle reaches from the first of the
/// four end points to the last (the largest of the six), between the lines; where they cross inside it, both
/// triangles count.
double quadrangleArea(const LineSegment2D<double> &p, const LineSegment2D<double> &q);

/// The older criterion for a set of pairs: the weighted sum of squared areas; m^4. Every evaluation goes
/// through all pairs, and it is not smooth: the baseline that EdgeSetComparator is measured against.
class QuadrangleCriterion {
public:
    /// False (and nothing added) when the pair is not usable.
    bool add(const SegmentPair &pair);
    void clear() { pairs_.clear(); }

    /// 0 without pairs.
    double operator()(const Transformation2D &t) const;

private:
    std::vector<SegmentPair> pairs_;
};

} // namespace vectorlib

#ifdef VECTORLIB_HEADER_ONLY
#include "vectorlib/src/similarity/QuadrangleCriterion.cpp"
#endif
