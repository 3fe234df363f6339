#pragma once

#include "vectorlib/segmentation/PolarScan.h"
#include "vectorlib/simd/Returns.h"

#include <type_traits>
#include <vector>

namespace vectorlib {

/// The returns of a scan, one after another. Keeps its buffers.
struct PolarReturns {
    std::vector<float> ranges; ///< metres; more than count()
    std::vector<int> rays;     ///< the ray of each
    std::size_t count = 0;

    template <typename Range>
    void take(const PolarScan<Range> &scan, simd::Level level) {
        constexpr std::size_t spare = 8; // SIMD writes eight at a time
        if (ranges.size() < scan.count + spare) {
            ranges.resize(scan.count + spare);
            rays.resize(scan.count + spare);
        }
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
};

} // namespace vectorlib
