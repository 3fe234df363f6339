#pragma once

#include "vectorlib/geometry/Vector2D.h"

namespace vectorlib {

/// The line ax + by + c = 0 with a unit normal (a, b); metres. Thesis eqs. (6.5), (6.6).
/// Fits from a scanner at the origin have c >= 0: the normal points to the scanner, that is to free space.
struct Line2D {
    double a = 0;
    double b = 0;
    double c = 0;

    /// False for the default line, which has no direction (isotropic or empty data).
    bool isValid() const { return a != 0 || b != 0; }
    /// Distance of a point from the line, positive on the side to which the normal points; metres.
    double signedDistance(Vector2D<double> p) const { return a * p.x + b * p.y + c; }
    /// (a, b).
    Vector2D<double> normal() const { return {a, b}; }
    /// The direction whose left normal is (a, b).
    Vector2D<double> direction() const { return {b, -a}; }
    /// The point of the line that is nearest to p.
    Vector2D<double> project(Vector2D<double> p) const { return p - normal() * signedDistance(p); }
};

/// Where two lines cross; false (and the point untouched) when they are parallel.
inline bool intersect(const Line2D &l, const Line2D &m, Vector2D<double> &point) {
    const double det = l.a * m.b - m.a * l.b;
    if (std::abs(det) < 1e-12)
        return false;
    point = {(l.b * m.c - m.b * l.c) / det, (m.a * l.c - l.a * m.c) / det};
    return true;
}

} // namespace vectorlib
