#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <limits>

namespace vectorlib {

/// The permitted set of transformations around the expected one; metres and radians. Defaults of the thesis
/// appendices.
struct PermittedError {
    double dx = 1.2;
    double dy = 1.2;
    double dalpha = 1.26;

    /// Whether a transformation is in the set, whose centre is the identity.
    bool holds(const Transformation2D &t) const {
        return std::abs(t.x()) <= dx && std::abs(t.y()) <= dy && std::abs(t.alpha()) <= dalpha;
    }
};

/// Whether some transformation of the permitted set, centred at the identity, brings `moving` onto the line
/// of `fixed` so that they share at least one point. Thesis 7.4.1 with (7.19): the perfect transformations of
/// the pair form a line P + tau v in the space of translations; it is clipped by the box |x| <= dx, |y| <= dy
/// and by the overlap, exactly.
inline bool mayCorrespond(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving,
                          const PermittedError &permitted) {
    const Vector2D<double> v = fixed.direction(), n = fixed.normal();
    const double cosine = moving.direction().dot(v), sine = moving.direction().cross(v);
    if (std::abs(std::atan2(sine, cosine)) > permitted.dalpha)
        return false;
    const double shift = fixed.begin().dot(n) - moving.begin().dot(moving.normal()); // erratum 6
    const Vector2D<double> p = n * shift;
    double from = -std::numeric_limits<double>::infinity(), to = -from;
    const auto clip = [&](double start, double slope, double limit) {
        if (std::abs(slope) < 1e-15)
            return std::abs(start) <= limit;
        const double a = (-limit - start) / slope, b = (limit - start) / slope;
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
        return from <= to;
    };
    if (!clip(p.x, v.x, permitted.dx) || !clip(p.y, v.y, permitted.dy))
        return false;
    // Rotated by alpha about the origin the moving segment keeps its extent along its own direction.
    const double moved = moving.begin().dot(moving.direction()), start = fixed.begin().dot(v);
    return moved + from <= start + fixed.length() && moved + moving.length() + to >= start;
}

} // namespace vectorlib
