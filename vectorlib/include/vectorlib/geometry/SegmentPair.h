#pragma once

#include "vectorlib/geometry/LineSegment2D.h"

namespace vectorlib {

/// Two segments that are known to be the same edge, seen in two frames; metres.
struct SegmentPair {
    LineSegment2D<double> fixed;  ///< of the static set
    LineSegment2D<double> moving; ///< of the dynamic set
    double weight = 1;
};

/// Whether a segment has a direction and finite ends: what registration and similarity need of it.
inline bool isUsable(const LineSegment2D<double> &s) {
    return s.isFinite() && s.direction().squaredNorm() > 0.5; // not so for a zero or NaN direction
}

/// Whether both segments are usable and the weight is a finite number above 0.
inline bool isUsable(const SegmentPair &p) {
    return isUsable(p.fixed) && isUsable(p.moving) && p.weight > 0 && std::isfinite(p.weight);
}

} // namespace vectorlib
