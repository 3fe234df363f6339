#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"

namespace vectorlib {

// The distances of two segments that thesis 7.1.4 sets the area criterion against; metres. NaN where a
// segment is not usable.

/// Hausdorff distance, thesis (7.1), (7.2): how far the point of one segment that is farthest from the other
/// lies from it. The distance to a segment bends up only, so that this point is an end. Not a perpendicular
/// distance, as the thesis says of it: beside the ends it is that to the end.
double hausdorffDistance(const LineSegment2D<double> &p, const LineSegment2D<double> &q);

/// "Modified" Hausdorff distance, thesis (7.3): the shorter length by the sine of the angle between the
/// lines. That angle is at most a right one: with the printed sine it would be below 0 beyond half a turn.
double modifiedHausdorffDistance(const LineSegment2D<double> &p, const LineSegment2D<double> &q);

/// "Modified perpendicular" Hausdorff distance, thesis (7.4) to (7.6): of the distances of the ends from the
/// other one's line the larger d1 and the smaller d2, each of the segment where it is less, weighted by
/// themselves. The weights add up to 1, so that the printed half in (7.6) would halve the distance of
/// parallel lines; it is left out. Where both are 0 the weights (7.5) are 0 / 0, and the distance is 0.
double perpendicularHausdorffDistance(const LineSegment2D<double> &p, const LineSegment2D<double> &q);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/similarity/HausdorffDistances.cpp")
