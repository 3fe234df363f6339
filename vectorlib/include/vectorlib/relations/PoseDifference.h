#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/relations/TypedSegment.h"

#include <vector>

namespace vectorlib {

/// The square of the length of the shorter: how precisely two segments tell an angle; m^2. Pose-free thesis
/// 5.6.1.
double precisionValue(const LineSegment2D<double> &a, const LineSegment2D<double> &b);

/// The rotation of matched segments, current onto reference; radians. Algorithm 8 with erratum 12: a circular
/// mean weighted by precision values, divided by their sum.
double rotationalDifference(const std::vector<CorrespondencePair> &pairs,
                            const std::vector<TypedSegment> &reference,
                            const std::vector<TypedSegment> &current);

/// The pose difference of two scans from matched segments: moves the current scan onto the reference.
/// Algorithms 8 and 9 with erratum 12: after the rotation the mean translation of the edges that both scans
/// have, each by the smaller precision value of the segments that form it. Without any such edge, of parallel
/// lines, the translation is 0 and the answer false.
bool poseDifference(const std::vector<CorrespondencePair> &pairs, const std::vector<TypedSegment> &reference,
                    const std::vector<TypedSegment> &current, double leastAngle, Transformation2D &pose);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/PoseDifference.cpp")
