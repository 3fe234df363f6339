#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace vectorlib {

/// Where the lines of two walls cross, whether or not the walls reach there. Two corners of the same turn tell
/// how one map lies on another; neither their turn nor where the walls begin and end about them depends on the
/// pose. The second wall is turned counter-clockwise against the first.
struct Corner {
    struct Side {
        int wall = 0;
        Vector2D<double> direction;
        double from = 0, to = 0; ///< of the wall along its direction, from the corner; metres
        double length() const { return to - from; }
    };
    Vector2D<double> position;
    Side first, second;
    double turn = 0; ///< from the first to the second; radians, in (0, pi)

    /// How far the nearer end of either wall is from the corner; metres.
    double gap() const { return std::max(gapOf(first), gapOf(second)); }

private:
    static double gapOf(const Side &side) { return std::max({0.0, side.from, -side.to}); }
};

struct CornerSettings {
    double leastTurn = 0.5; ///< lines that are more alike do not fix a place; radians
    double widestGap = 1.0; ///< that a wall must be prolonged by; metres
};

/// The corner of two walls; nothing where they are too much alike or too far from it.
inline std::optional<Corner> cornerOf(int a, const LineSegment2D<double> &wallA, int b,
                                      const LineSegment2D<double> &wallB, const CornerSettings &settings) {
    const double sine = wallA.direction().cross(wallB.direction());
    if (!(std::abs(sine) >= std::sin(settings.leastTurn)))
        return std::nullopt;
    const bool isFirst = sine > 0;
    const LineSegment2D<double> &one = isFirst ? wallA : wallB, &other = isFirst ? wallB : wallA;
    const double along = (other.begin() - one.begin()).cross(other.direction()) / std::abs(sine);
    Corner corner;
    corner.position = one.begin() + one.direction() * along;
    const double there = other.along(corner.position);
    corner.first = {isFirst ? a : b, one.direction(), -along, one.length() - along};
    corner.second = {isFirst ? b : a, other.direction(), -there, other.length() - there};
    if (corner.gap() > settings.widestGap)
        return std::nullopt;
    corner.turn = std::atan2(std::abs(sine), one.direction().dot(other.direction()));
    return corner;
}

} // namespace vectorlib
