#pragma once

#include "vectorlib/segmentation/CartesianNearSimd.h"
#include "vectorlib/segmentation/PolarNearSimd.h"

#include <type_traits>

namespace vectorlib {

/// Compares the points of a scan by a `Nearness`, eight at a time where the processor and the type allow it.
/// The result does not depend on that.
template <typename Nearness>
struct Comparison {
    Nearness nearness;
    simd::Level level;

    std::size_t count() const { return nearness.count; }

    /// Compares all points with their direct predecessors; `words` are zero, one for each 64 begun.
    void withPredecessors(NearWord *words) const {
        std::size_t i = 1;
        if constexpr (inEights)
            if (level != simd::Level::Scalar && count() > 8) {
                const std::size_t eights = (count() - 1) / 8;
                simd::nearPredecessors(nearness, eights, words);
                i += 8 * eights;
            }
        for (; i < count(); ++i)
            if (nearness.near(i, i - 1)) {
                NearWord &word = words[(i - 1) / NearWord::bits];
                word.near |= std::uint64_t(1) << (i - 1) % NearWord::bits;
                word.widest = std::max(word.widest, static_cast<double>(nearness.gap(i, i - 1)));
            }
    }
    /// Whether point i is near one of the earlier points first .. end - 1.
    bool nearEarlier(std::size_t i, std::size_t first, std::size_t end) const {
        if constexpr (inEights)
            if (worthEights(first, end))
                return simd::anyNear(nearness, first, end, i, {0, nearness.limit(i), nearness.limit(i)});
        for (std::size_t j = end; j-- > first;)
            if (nearness.near(i, j))
                return true;
        return false;
    }
    /// Whether one of the later points first .. end - 1 is near point j.
    bool nearLater(std::size_t first, std::size_t end, std::size_t j) const {
        if constexpr (inEights)
            if (worthEights(first, end))
                return simd::anyNear(nearness, first, end, j, nearness.threshold);
        for (std::size_t i = first; i < end; ++i)
            if (nearness.near(i, j))
                return true;
        return false;
    }

private:
#if defined(VECTORLIB_SIMD_AVX2)
    static constexpr bool inEights =
        std::is_same_v<Nearness, CartesianNearness<float>> || std::is_same_v<Nearness, PolarNearness>;
#else
    static constexpr bool inEights = false;
#endif

    bool worthEights(std::size_t first, std::size_t end) const {
        return level != simd::Level::Scalar && count() >= 8 && end - first > 1;
    }
};

} // namespace vectorlib
