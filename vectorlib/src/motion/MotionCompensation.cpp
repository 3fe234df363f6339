#include "vectorlib/motion/MotionCompensation.h"

#include "vectorlib/geometry/Transformation2D.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY float middleTime(const std::vector<float> &seconds) {
    if (seconds.empty())
        return 0;
    const auto [first, last] = std::minmax_element(seconds.begin(), seconds.end());
    return (*first + *last) / 2;
}

VECTORLIB_BODY void compensateMotion(std::vector<Vector2D<float>> &points, const std::vector<float> &seconds,
                                     float reference, const Twist2D &twist) {
    for (std::size_t i = 0; i < points.size() && i < seconds.size(); ++i)
        points[i] = Transformation2D(twist, seconds[i] - reference) * points[i];
}

} // namespace vectorlib
