#include "vectorlib/correspondence/ExpectedViewTest.h"

namespace vectorlib {

VECTORLIB_BODY void ExpectedViewTest::setFixed(const Segments &fixed, const Transformation2D *seenFrom) {
    fixed_ = &fixed;
    obstacles_.clear();
    if (!seenFrom)
        return;
    for (const LineSegment2D<double> &border : frontier_(observe_(fixed, seenFrom->pose())))
        obstacles_.push_back(*seenFrom * border);
}

VECTORLIB_BODY void ExpectedViewTest::setMoving(const Segments &moving) {
    observed_ = observe_(moving, {});
    observedAngle_ = 0;
    for (const VisiblePart<double> &part : observed_) {
        const Vector2D<double> begin = part.segment.begin(), end = part.segment.end();
        observedAngle_ += std::atan2(begin.cross(end), begin.dot(end));
    }
}

} // namespace vectorlib
