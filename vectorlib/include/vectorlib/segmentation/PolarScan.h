#pragma once

#include "vectorlib/geometry/Vector2D.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace vectorlib {

/// A scan as a lidar gives it: ranges at even steps of the angle, owned by somebody else. Ranges are float or
/// double, or integers of `scale` metres each. A range that is 0, negative, NaN, infinite, under minRange or
/// at or over maxRange is no return.
template <typename Range>
struct PolarScan {
    const Range *ranges = nullptr;
    std::size_t count = 0;
    double startAngle = 0; ///< of the first ray; radians
    double step = 0;       ///< from ray to ray; radians, negative for a scanner that turns clockwise
    double scale = 1;      ///< metres in a unit of range
    double minRange = 0;   ///< metres
    double maxRange = std::numeric_limits<double>::infinity(); ///< metres

    /// In metres.
    double range(std::size_t i) const { return static_cast<double>(ranges[i]) * scale; }
    /// A return is at least least() and less than end(), and so positive and small enough for a float.
    bool isReturn(double metres) const { return metres >= least() && metres < end(); }
    double least() const { return minRange <= 0 ? std::numeric_limits<double>::denorm_min() : minRange; }
    double end() const { return std::min(maxRange, static_cast<double>(std::numeric_limits<float>::max())); }
    /// The point of ray i in the scanner's frame; metres. Of no meaning where it is no return.
    Vector2D<double> point(std::size_t i) const {
        const double angle = startAngle + step * static_cast<double>(i);
        return Vector2D<double>(std::cos(angle), std::sin(angle)) * range(i);
    }
};

} // namespace vectorlib
