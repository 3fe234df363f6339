#pragma once

#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/tls/TlsSums.h"

namespace vectorlib {

/// What the end of a segment is. Pose-free thesis 3.2, 3.3. Angle and Jump are edge points: the structure
/// ends there. At an Interior end it may go on unseen.
enum class EndType { Interior, Jump, Angle };

/// One end of a segment.
struct SegmentEnd {
    EndType type = EndType::Interior;
    double slack = 0; ///< how far from the true end it may lie; metres
    /// Of a jump: the largest relative angle (4.3) of what may be hidden behind it; radians. 2 pi: unknown.
    double bound = 2 * pi;

    bool isEdge() const { return type != EndType::Interior; }
};

/// A segment of a scan with what is known of its ends; sensor frame, free space on the left, so that the
/// sensor turning counter-clockwise sees it from begin to end. Pose-free thesis 3.2.
struct TypedSegment {
    LineSegment2D<double> segment; ///< metres
    SegmentEnd begin, end;         ///< what its two ends are
    bool joined = false; ///< its end and the begin of the next segment of the scan are one angle edge
    TlsSums sums;        ///< of points that are surely its own, sensor frame; n = 0 where there are none

    /// Both ends are edge points: its length is that of the structure.
    bool isComplete() const { return begin.isEdge() && end.isEdge(); }
};

/// The relative angle from one segment to another, counter-clockwise, in [0, 2 pi). Pose-free thesis 4.3: the
/// angle at which the second lies when the ends of both are put together and the first lies on the x axis.
inline double relativeAngle(const LineSegment2D<double> &from, const LineSegment2D<double> &to) {
    const Vector2D<double> a = from.direction(), b = to.direction();
    const double angle = std::atan2(a.cross(b), a.dot(b));
    return angle < 0 ? angle + 2 * pi : angle;
}

} // namespace vectorlib
