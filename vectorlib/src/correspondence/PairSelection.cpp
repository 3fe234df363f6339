#include "vectorlib/correspondence/PairSelection.h"

namespace vectorlib {

VECTORLIB_BODY Transformation2D PairSelection::operator()(const std::vector<PotentialPair> &candidates,
                                                          const Segments &fixed, const Segments &moving,
                                                          Transformation2D t) {
    for (int i = 0; i < steps; ++i) {
        const double wide = std::pow(0.5, i);
        choose(candidates, fixed, moving, t, std::max(distance, wideDistance * wide),
               std::max(angle, wideAngle * wide));
        refinement_.start(1e-9, 1e-9);
        for (const CorrespondencePair &p : pairs_)
            refinement_.add(at(fixed, p.fixed), sumsOf(t * at(moving, p.moving)), 1);
        t = refinement_.step() * t;
    }
    choose(candidates, fixed, moving, t, distance, angle);
    return t;
}

VECTORLIB_BODY double PairSelection::energy(const LineSegment2D<double> &fixed,
                                            const LineSegment2D<double> &moved, const Stiffness &stiffness) {
    const double turn =
        std::atan2(moved.direction().cross(fixed.direction()), moved.direction().dot(fixed.direction()));
    const double apart = fixed.across(moved.middle());
    return stiffness.alpha * turn * turn + stiffness.xy * apart * apart;
}

VECTORLIB_BODY TlsSums PairSelection::sumsOf(const LineSegment2D<double> &s) {
    const double n = s.length(), moment = n * n * n / 12;
    const Vector2D<double> v = s.direction();
    TlsSums sums;
    sums.n = n;
    sums.mean = s.middle();
    sums.xx = moment * v.x * v.x;
    sums.xy = moment * v.x * v.y;
    sums.yy = moment * v.y * v.y;
    return sums;
}

VECTORLIB_BODY void PairSelection::choose(const std::vector<PotentialPair> &candidates, const Segments &fixed,
                                          const Segments &moving, const Transformation2D &t, double gate,
                                          double turn) {
    pairs_.clear();
    for (const PotentialPair &c : candidates) {
        const LineSegment2D<double> &line = at(fixed, c.numbers.fixed);
        if (std::abs(wrapAngle(c.alpha - t.alpha())) > turn)
            continue;
        const LineSegment2D<double> moved = t * at(moving, c.numbers.moving);
        if (line.meanSquareAcross(moved) <= gate * gate &&
            line.overlap(moved) >= overlap * std::min(line.length(), moved.length()))
            pairs_.push_back(c.numbers);
    }
}

} // namespace vectorlib
