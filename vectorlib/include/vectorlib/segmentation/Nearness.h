#pragma once

#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/simd/Simd.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

/// Of a distance: for each metre of range, and its bounds; or all three squared.
template <typename Scalar>
struct NearThreshold {
    Scalar scale, least, most;

    /// The threshold at a range: `scale` times it, within `least` and `most`.
    Scalar operator()(Scalar range) const {
        const Scalar scaled = scale * range, low = scaled > least ? scaled : least;
        return low < most ? low : most;
    }
};

/// When two points of a scan belong together, in Cartesian coordinates: Euclidean distance up to a threshold
/// that grows with the range of the later one. Thesis figure 5.2a, (5.1). Everything squared: no root. While
/// the largest threshold is finite, a point that is not is near no other.
template <typename Scalar>
struct CartesianNearness {
    const Vector2D<Scalar> *points;
    std::size_t count;
    NearThreshold<Scalar> threshold;

    /// Whether point i, the later one, belongs to point j.
    bool near(std::size_t i, std::size_t j) const { return gap(i, j) <= limit(i); }
    /// The square of the threshold for point i.
    Scalar limit(std::size_t i) const {
        return threshold(points[i].x * points[i].x + points[i].y * points[i].y);
    }
    /// Squared distance.
    Scalar gap(std::size_t i, std::size_t j) const {
        const Scalar dx = points[i].x - points[j].x, dy = points[i].y - points[j].y;
        return dx * dx + dy * dy;
    }
};

/// The same in polar coordinates, thesis figure 5.2b: angle and range are compared by themselves, so there is
/// no trigonometry; only the threshold of the range is scaled.
struct PolarNearness {
    const float *ranges;
    const int *rays; ///< of each range
    std::size_t count;
    NearThreshold<float> threshold;
    int reach, turn; ///< largest number of rays between neighbours; rays of a turn, INT_MAX: no turn
    double step;     ///< between rays; radians

    bool near(std::size_t i, std::size_t j) const {
        return std::abs(ranges[i] - ranges[j]) <= limit(i) && between(i, j) <= reach;
    }
    /// The threshold of the range for point i; metres.
    float limit(std::size_t i) const { return threshold(ranges[i]); }
    /// How many rays apart two points are.
    int between(std::size_t i, std::size_t j) const {
        const int ahead = std::abs(rays[i] - rays[j]);
        return std::min(ahead, turn - ahead);
    }
    /// Squared distance, the arc taken for its chord.
    double gap(std::size_t i, std::size_t j) const {
        const double dr = ranges[i] - ranges[j], arc = ranges[i] * (between(i, j) * step);
        return dr * dr + arc * arc;
    }
};

/// What comparing 64 points with their direct predecessors gives: bit k of word w is for points 64 w + k and
/// 64 w + k + 1.
struct NearWord {
    static constexpr std::size_t bits = 64;

    std::uint64_t near = 0; ///< which points are near their predecessors
    double widest = 0;      ///< at least the largest gap() between those that are
};

} // namespace vectorlib
