#pragma once

#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/PointSpan.h"
#include "vectorlib/segmentation/PolarScan.h"
#include "vectorlib/simd/Returns.h"

#include <type_traits>
#include <vector>

namespace vectorlib {

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
