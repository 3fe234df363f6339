#include "vectorlib/correspondence/PotentialPairs.h"

#include <limits>

namespace vectorlib {

VECTORLIB_BODY bool mayCorrespond(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving,
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
