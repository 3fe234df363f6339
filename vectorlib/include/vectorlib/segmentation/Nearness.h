#pragma once

#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/simd/Simd.h"

#include <cmath>
#include <type_traits>

namespace vectorlib {

/// The widest gap found so far, and the later one of the two points.
template <typename Number>
struct Gap {
    Number size;
    std::size_t at;
};

/// When two points of a scan belong together, in Cartesian coordinates: Euclidean distance up to a threshold
/// that grows with the range of the later one. Thesis figure 5.2a, (5.1). Everything squared: no root.
template <typename Scalar>
struct CartesianNearness {
    const Vector2D<Scalar> *points;
    Scalar scale, least, most; // of the squared threshold: for each m^2 of squared range, and its bounds

    bool near(std::size_t i, std::size_t j) const {
        const Scalar x = points[i].x, y = points[i].y, scaled = scale * (x * x + y * y);
        const Scalar low = scaled > least ? scaled : least, limit = low < most ? low : most;
        return gap(i, j) <= limit;
    }
    /// Squared distance.
    Scalar gap(std::size_t i, std::size_t j) const {
        const Scalar dx = points[i].x - points[j].x, dy = points[i].y - points[j].y;
        return dx * dx + dy * dy;
    }
    /// flags[i] = near(i, i - 1) for i = 1 .. count - 1.
    void flag(std::size_t count, simd::Level level, std::uint8_t *flags) const {
        std::size_t i = 1;
#if defined(VECTORLIB_SIMD_AVX2)
        if constexpr (std::is_same_v<Scalar, float>)
            if (level == simd::Level::Avx2 && count > 8) {
                const std::size_t eights = (count - 1) / 8;
                simd::nearAvx2(&points->x, eights, scale, least, most, flags + 1);
                i += 8 * eights;
            }
#endif
        static_cast<void>(level);
        for (; i < count; ++i)
            flags[i] = near(i, i - 1);
    }
    /// Looks for a wider gap among consecutive points begin .. end - 1: 64 at a time, point by point where
    /// one is.
    void widen(std::size_t begin, std::size_t end, simd::Level level, Gap<Scalar> &widest) const {
        std::size_t i = begin + 1;
#if defined(VECTORLIB_SIMD_AVX2)
        if constexpr (std::is_same_v<Scalar, float>)
            for (; level == simd::Level::Avx2 && i + 64 <= end; i += 64)
                if (simd::widestAvx2(&points[i - 1].x, 8) > widest.size)
                    widenPlain(i, i + 64, widest);
#endif
        static_cast<void>(level);
        widenPlain(i, end, widest);
    }

private:
    void widenPlain(std::size_t i, std::size_t end, Gap<Scalar> &widest) const {
        for (; i < end; ++i)
            if (const Scalar g = gap(i, i - 1); g > widest.size)
                widest = {g, i};
    }
};

/// The same in polar coordinates, thesis figure 5.2b: angle and range are compared by themselves, so there is
/// no trigonometry; only the threshold of the range is scaled.
struct PolarNearness {
    const float *ranges;
    const int *rays;          // of each range
    float scale, least, most; // of the threshold: for each metre of range, and its bounds
    int reach, turn;          // largest number of rays between neighbours; rays of a turn, 0: no turn
    double step;              // between rays; radians

    int between(std::size_t i, std::size_t j) const {
        const int rays_ = std::abs(rays[i] - rays[j]);
        return turn > 0 && turn - rays_ < rays_ ? turn - rays_ : rays_;
    }
    bool near(std::size_t i, std::size_t j) const {
        const float scaled = scale * ranges[i], low = scaled > least ? scaled : least;
        const float limit = low < most ? low : most;
        return (std::abs(ranges[i] - ranges[j]) <= limit) & (between(i, j) <= reach);
    }
    /// Squared distance, the arc taken for its chord.
    double gap(std::size_t i, std::size_t j) const {
        const double dr = ranges[i] - ranges[j], arc = ranges[i] * (between(i, j) * step);
        return dr * dr + arc * arc;
    }
    void flag(std::size_t count, simd::Level, std::uint8_t *flags) const {
        for (std::size_t i = 1; i < count; ++i)
            flags[i] = near(i, i - 1);
    }
    void widen(std::size_t begin, std::size_t end, simd::Level, Gap<double> &widest) const {
        for (std::size_t i = begin + 1; i < end; ++i)
            if (const double g = gap(i, i - 1); g > widest.size)
                widest = {g, i};
    }
};

} // namespace vectorlib
