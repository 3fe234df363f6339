#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/relations/TypedSegment.h"

#include <vector>

namespace vectorlib {

/// How many measured things of matched segments agree. Three are needed to tell a place from its like: two
/// lines that cross at a right angle fit any corner of any room.
class MatchSigns {
public:
    double distance = 0.10;       ///< of equal lines and ends; metres
    double angle = 10 * pi / 180; ///< from parallel or square, within which it tells nothing; radians

    /// The number of different lines among the pairs, and of jumps at which a segment ends in both scans, and
    /// one if two lines are neither parallel nor square. A corner counts by its two lines. Quadratic in the
    /// pairs. The pose brings the current scan onto the reference.
    int operator()(const std::vector<CorrespondencePair> &pairs, const std::vector<TypedSegment> &reference,
                   const std::vector<TypedSegment> &current, const Transformation2D &pose) const;

private:
    bool isSameLine(const LineSegment2D<double> &a, const LineSegment2D<double> &b) const;
    bool isSquare(const LineSegment2D<double> &a, const LineSegment2D<double> &b) const;
    int commonJumps(const TypedSegment &r, const TypedSegment &c, const Transformation2D &pose) const;
    bool isCommonJump(const SegmentEnd &a, Vector2D<double> there, const SegmentEnd &b,
                      Vector2D<double> here) const;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/MatchSigns.cpp")
