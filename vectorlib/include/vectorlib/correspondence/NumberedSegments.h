#pragma once

#include "vectorlib/geometry/LineSegment2D.h"

#include <vector>

namespace vectorlib {

/// The usable ones of a caller's segments, with their numbers there.
struct NumberedSegments {
    std::vector<LineSegment2D<double>> segments;
    std::vector<int> numbers;

    void clear() {
        segments.clear();
        numbers.clear();
    }
    /// Segments that are not finite or have no length are left out.
    void take(const LineSegment2D<double> &s, int number) {
        if (s.isFinite() && s.direction().squaredNorm() > 0.5) {
            segments.push_back(s);
            numbers.push_back(number);
        }
    }
};

} // namespace vectorlib
