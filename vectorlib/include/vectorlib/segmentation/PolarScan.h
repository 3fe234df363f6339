#pragma once

#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/simd/Returns.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

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

/// The returns of a scan, one after another. Keeps its buffers.
struct PolarReturns {
    static constexpr int turn = 1 << 30;               ///< as many directions are told apart of points
    static constexpr double direction = 2 * pi / turn; ///< radians

    std::vector<float> ranges; ///< metres; more than count
    std::vector<int> rays;     ///< the ray of each; of points their direction
    std::vector<int> taken;    ///< of points: which they are
    std::size_t count = 0;

    /// Points in the scanner's frame; those without finite range are left out.
    template <typename Scalar>
    void take(PointSpan<Scalar> points) {
        grow(points.size());
        taken.resize(points.size());
        count = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double x = points[i].x, y = points[i].y, range = std::hypot(x, y);
            if (!(range < static_cast<double>(std::numeric_limits<float>::max())))
                continue;
            ranges[count] = static_cast<float>(range);
            rays[count] = static_cast<int>(std::lround(std::atan2(y, x) / direction));
            taken[count++] = static_cast<int>(i);
        }
    }

    /// The returns of a scan by ranges, each with the number of its ray.
    template <typename Range>
    void take(const PolarScan<Range> &scan, simd::Level level) {
        grow(scan.count);
        count = 0;
        std::size_t i = 0;
#if defined(VECTORLIB_SIMD_AVX2)
        if constexpr (std::is_same_v<Range, float> || std::is_same_v<Range, std::uint16_t>)
            if (level != simd::Level::Scalar) {
                const simd::RangeBounds bounds{scan.scale, scan.least(), scan.end()};
                count = simd::returns(scan.ranges, scan.count / 8, bounds, ranges.data(), rays.data());
                i = scan.count / 8 * 8;
            }
#endif
        static_cast<void>(level);
        for (; i < scan.count; ++i) {
            const double r = scan.range(i);
            ranges[count] = static_cast<float>(r); // overwritten where it is no return
            rays[count] = static_cast<int>(i);
            count += scan.isReturn(r);
        }
    }

private:
    void grow(std::size_t points) {
        constexpr std::size_t spare = 8; // SIMD writes eight at a time
        if (ranges.size() < points + spare) {
            ranges.resize(points + spare);
            rays.resize(points + spare);
        }
    }
};

} // namespace vectorlib
