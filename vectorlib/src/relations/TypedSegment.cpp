#include "vectorlib/relations/TypedSegment.h"

#include "vectorlib/geometry/SegmentPair.h"

namespace vectorlib {

VECTORLIB_BODY double relativeAngle(const LineSegment2D<double> &from, const LineSegment2D<double> &to) {
    const Vector2D<double> a = from.direction(), b = to.direction();
    const double angle = std::atan2(a.cross(b), a.dot(b));
    return angle < 0 ? angle + 2 * pi : angle;
}

} // namespace vectorlib
