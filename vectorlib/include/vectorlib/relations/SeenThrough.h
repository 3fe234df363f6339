#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/relations/TypedSegment.h"

#include <vector>

namespace vectorlib {

/// How much of one scan stands where the other has looked through: what is between a sensor and a segment
/// that it sees is free. Two rooms that are alike but not the same contradict each other so.
class SeenThrough {
public:
    double margin = 0.25; ///< how far in front of the other's segment counts; metres
    int samples = 4;      ///< along each segment

    /// Length of the segments of either scan that stand in the free space of the other when the pose brings
    /// the current scan onto the reference; metres.
    double operator()(const std::vector<TypedSegment> &reference, const std::vector<TypedSegment> &current,
                      const Transformation2D &pose) const;

private:
    double standingIn(const std::vector<TypedSegment> &seen, const std::vector<TypedSegment> &others,
                      const Transformation2D &pose) const;
    // Between the sensor, in the origin, and a segment of its scan, by more than the margin.
    bool isInFront(const std::vector<TypedSegment> &seen, Vector2D<double> p) const;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/SeenThrough.cpp")
