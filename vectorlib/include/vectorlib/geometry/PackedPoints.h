#pragma once

#include "vectorlib/geometry/Vector2D.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vectorlib {

/// Points that are kept for long, in half the memory: coordinates as 16 bits each, in steps of the largest
/// one divided by 32767 (0.6 mm where the farthest point is at 20 m). Points that are not finite or farther
/// than `farthest` in x or y are left out.
class PackedPoints {
public:
    static constexpr float farthest = 300; ///< metres

    PackedPoints() = default;
    explicit PackedPoints(PointSpan<float> points) {
        const auto isKept = [](const Vector2D<float> &p) {
            return std::abs(p.x) <= farthest && std::abs(p.y) <= farthest;
        };
        float most = 0;
        for (const Vector2D<float> &p : points)
            if (isKept(p))
                most = std::max({most, std::abs(p.x), std::abs(p.y)});
        constexpr float least = 1e-6F; // of all points in one place
        step_ = std::max(most / INT16_MAX, least);
        coordinates_.reserve(2 * points.size());
        for (const Vector2D<float> &p : points)
            if (isKept(p)) {
                coordinates_.push_back(packed(p.x));
                coordinates_.push_back(packed(p.y));
            }
    }
    std::size_t size() const { return coordinates_.size() / 2; }
    /// Memory beside the object itself.
    std::size_t bytes() const { return coordinates_.capacity() * sizeof(std::int16_t); }
    /// In the order in which they were given.
    void unpack(std::vector<Vector2D<float>> &points) const {
        points.clear();
        for (std::size_t i = 0; i < coordinates_.size(); i += 2)
            points.emplace_back(coordinates_[i] * step_, coordinates_[i + 1] * step_);
    }

private:
    std::int16_t packed(float v) const {
        const long steps = std::lround(v / step_);
        return static_cast<std::int16_t>(std::clamp<long>(steps, -INT16_MAX, INT16_MAX));
    }

    float step_ = 0; // metres
    std::vector<std::int16_t> coordinates_;
};

} // namespace vectorlib
