#pragma once

#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Twist2D.h"

#include <algorithm>
#include <vector>

namespace vectorlib {

/// The middle between the first and the last of the points' times; 0 without any. The best time to refer a
/// scan to: a wrong velocity then bends the scan without shifting it, while at its beginning the shift would
/// come back as a wrong velocity of the next scan, and grow.
inline float middleTime(const std::vector<float> &seconds) {
    if (seconds.empty())
        return 0;
    const auto [first, last] = std::minmax_element(seconds.begin(), seconds.end());
    return (*first + *last) / 2;
}

/// Moves points measured while the sensor moved to where they would have been seen from its place at time
/// `reference`. `seconds` holds the time of each point; both of the same size, or no times for a scan
/// measured at once.
inline void compensateMotion(std::vector<Vector2D<float>> &points, const std::vector<float> &seconds,
                             float reference, const Twist2D &twist) {
    for (std::size_t i = 0; i < points.size() && i < seconds.size(); ++i)
        points[i] = Transformation2D(twist, seconds[i] - reference) * points[i];
}

} // namespace vectorlib
