#pragma once

#include "vectorlib/segmentation/CartesianNearSimd.h"
#include "vectorlib/segmentation/PolarNearSimd.h"

#include <limits>
#include <type_traits>

namespace vectorlib {

#if !defined(VECTORLIB_SIMD_AVX2) && !defined(VECTORLIB_SIMD_NEON)
namespace simd {
/// Without AVX2 and NEON only declared, for Comparison to name; never called.
template <typename Nearness>
void nearPredecessors(const Nearness &, std::size_t, NearWord *);
/// The same.
template <typename Nearness>
unsigned nearBits(const Nearness &, std::size_t, std::size_t, bool);
} // namespace simd
#endif

/// Compares the points of a scan by a `Nearness`, eight at a time where the processor and the type allow it.
/// The result does not depend on that.
template <typename Nearness>
struct Comparison {
    Nearness nearness;
    simd::Level level;

    std::size_t count() const { return nearness.count; }

    /// Compares all points with their direct predecessors, 64 in a word.
    void withPredecessors(NearWord *words) const {
        std::size_t done = 0;
        if constexpr (inEights)
            if (level != simd::Level::Scalar && count() > NearWord::bits) {
                done = (count() - 1) / NearWord::bits;
                simd::nearPredecessors(nearness, done * NearWord::bits / 8, words);
            }
        for (std::size_t first = done * NearWord::bits + 1; first < count(); first += NearWord::bits)
            words[done++] = wordOf(first, std::min(NearWord::bits, count() - first));
    }
    /// Whether point `other` is near one of the points first .. end - 1, which all come before it, or all
    /// after it if not `later`.
    bool nearAny(std::size_t first, std::size_t end, std::size_t other, bool later) const {
        bool any = false;
        eachNear(first, end, other, later, [&](std::size_t) {
            any = true;
            return false;
        });
        return any;
    }
    /// Calls `take` with each of these points that is near, the last one first, until it returns false.
    template <typename Take>
    void eachNear(std::size_t first, std::size_t end, std::size_t other, bool later, Take take) const {
        if constexpr (inEights)
            if (level != simd::Level::Scalar && count() >= 8 && end - first > 1) {
                while (first < end) {
                    const std::size_t start = end - first < 8 ? std::min(first, count() - 8) : end - 8;
                    const unsigned wanted = first > start ? 0xffu << (first - start) : 0xffu;
                    const unsigned bits =
                        simd::nearBits(nearness, start, other, later) & wanted & ((1u << (end - start)) - 1);
                    for (unsigned k = 8; bits != 0 && k-- > 0;)
                        if ((bits >> k & 1) && !take(start + k))
                            return;
                    end = std::max(first, start);
                }
                return;
            }
        for (std::size_t i = end; i-- > first;)
            if (later ? nearness.near(other, i) : nearness.near(i, other))
                if (!take(i))
                    return;
    }

private:
#if defined(VECTORLIB_SIMD_AVX2) || defined(VECTORLIB_SIMD_NEON)
    static constexpr bool inEights =
        std::is_same_v<Nearness, CartesianNearness<float>> || std::is_same_v<Nearness, PolarNearness>;
#else
    static constexpr bool inEights = false;
#endif

    // The scalar twin of simd::nearPredecessors(), without the widest gap, which the search then finds. No
    // branches, so that compilers can vectorise it.
    NearWord wordOf(std::size_t first, std::size_t points) const {
        std::uint8_t flags[NearWord::bits];
        for (std::size_t k = 0; k < points; ++k)
            flags[k] = nearness.near(first + k, first + k - 1);
        std::uint64_t near = 0;
        for (std::size_t k = 0; k < points; ++k)
            near |= std::uint64_t(flags[k]) << k;
        return {near, std::numeric_limits<double>::infinity()};
    }
};

} // namespace vectorlib
