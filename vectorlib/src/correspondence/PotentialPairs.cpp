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

VECTORLIB_BODY bool PairCollector::operator()(const Segments &fixed, const Segments &moving,
                                              const SearchSettings &settings,
                                              std::vector<PotentialPair> &pairs) {
    pairs.clear();
    const double cosine = std::cos(std::min(pi, settings.permitted.dalpha)) - 1e-9;
    lines_.build(fixed, std::hypot(settings.permitted.dx, settings.permitted.dy));
    std::size_t compared = 0;
    const auto isWithinBounds = [&] {
        return compared <= settings.maxCompared && pairs.size() <= settings.maxPairs;
    };
    for (std::size_t m = 0; m < moving.size() && isWithinBounds(); ++m)
        lines_.query(moving[m], [&](int f) {
            ++compared;
            const LineSegment2D<double> &line = fixed[static_cast<std::size_t>(f)];
            if (line.direction().dot(moving[m].direction()) >= cosine && // most end here
                mayCorrespond(line, moving[m], settings.permitted))
                pairs.emplace_back(CorrespondencePair{f, static_cast<int>(m)}, line, moving[m],
                                   settings.stiffness);
            return isWithinBounds();
        });
    return isWithinBounds();
}

} // namespace vectorlib
