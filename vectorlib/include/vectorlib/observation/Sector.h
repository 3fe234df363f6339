#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Vector2D.h"

#include <cstddef>

namespace vectorlib {

/// A direction as a number that grows counter-clockwise like its angle, without trigonometry: 0 ahead, 1 to
/// the left, 2 (from above) and -2 (from below) behind.
double turnOf(Vector2D<double> d);

/// The line of an edge as it is seen from the origin: normal.p = distance.
struct SightLine {
    Vector2D<double> normal; ///< unit, away from the origin
    double distance = 0;     ///< metres, from 0 on

    SightLine() = default;
    SightLine(Vector2D<double> begin, Vector2D<double> end);
    /// Where a direction (of any length) that does not run along the line meets it.
    Vector2D<double> meet(Vector2D<double> direction) const {
        return direction * (distance / normal.dot(direction));
    }
};

/// Below 0 where `a` is nearer than `b` in a direction that meets both, above 0 where it is farther, 0 where
/// they cross; linear in the direction. Rounding counts as a crossing.
double compareDistance(const SightLine &a, const SightLine &b, Vector2D<double> direction);

/// An edge between two directions, under less than half a turn.
struct Sector {
    double right = 0, left = 0;                 ///< turnOf the two directions, right <= left
    Vector2D<double> towardsRight, towardsLeft; ///< the two directions, of any length
    std::size_t edge = 0;                       ///< number of the edge
};

/// Calls take(sector) for a sector, or, where it crosses the direction straight behind, for its two halves.
/// `right` and `left` are the ends of the edge as the origin sees them.
template <typename Take>
void cutBehind(Vector2D<double> right, Vector2D<double> left, std::size_t edge, Take take) {
    const Sector whole{turnOf(right), turnOf(left), right, left, edge};
    if (whole.right <= whole.left) {
        take(whole);
        return;
    }
    const Vector2D<double> behind(-1, 0);
    if (whole.right < 2)
        take(Sector{whole.right, 2, right, behind, edge});
    if (whole.left > -2)
        take(Sector{-2, whole.left, behind, left, edge});
}

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/observation/Sector.cpp")
