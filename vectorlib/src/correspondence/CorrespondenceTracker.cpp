#include "vectorlib/correspondence/CorrespondenceTracker.h"

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

VECTORLIB_BODY TrackingSettings TrackingSettings::forPoorExpectation() {
    TrackingSettings s;
    s.permitted = {2, 2, 1.26};
    s.expectedDeviationXY = 1;
    s.expectedDeviationAlpha = 0.5;
    s.minMatchedShare = 0.3;
    return s;
}

VECTORLIB_BODY const Match &CorrespondenceTracker::operator()(const std::vector<LineSegment2D<double>> &fixed,
                                                              const std::vector<EdgeRaw2D> &moving,
                                                              const Transformation2D &expected) {
    // Everything happens in the expected sensor frame, where segments are near the origin (erratum 13).
    const Transformation2D toLocal = expected.inverse();
    fixed_.clear();
    for (const LineSegment2D<double> &segment : fixed)
        fixed_.push_back(toLocal * segment);
    moving_ = &moving;
    collectCandidates();

    Transformation2D best = track(Transformation2D());
    double bestScore = score(best);
    bestPairs_ = pairs_;
    for (double alpha : votes_.peaks(settings.rotations)) {
        const Transformation2D other = track(Transformation2D(0, 0, alpha));
        const double otherScore = score(other);
        if (otherScore > bestScore) {
            bestScore = otherScore;
            best = other;
            bestPairs_ = pairs_;
        }
    }
    conclude(expected, best);
    return match_;
}

VECTORLIB_BODY void CorrespondenceTracker::collectCandidates() {
    candidates_.clear();
    votes_.start(settings.permitted.dalpha);
    const double cosine = std::cos(std::min(pi, settings.permitted.dalpha)) - 1e-9;
    for (std::size_t d = 0; d < moving_->size(); ++d)
        for (std::size_t s = 0; s < fixed_.size(); ++s) {
            const LineSegment2D<double> &moving = (*moving_)[d].segment, &fixed = fixed_[s];
            if (fixed.direction().dot(moving.direction()) < cosine || // most end here
                !mayCorrespond(fixed, moving, settings.permitted))
                continue;
            candidates_.push_back({static_cast<int>(s), static_cast<int>(d)});
            votes_.add(angleBetween(fixed, moving), std::min(fixed.length(), moving.length()));
        }
}

VECTORLIB_BODY Transformation2D CorrespondenceTracker::track(Transformation2D correction) {
    double gate = std::max(settings.permitted.dx, settings.permitted.dy), angle = settings.permitted.dalpha;
    for (int i = 0; i < settings.iterations; ++i) {
        choosePairs(correction, gate, angle);
        const Transformation2D step = refine(correction);
        correction = step * correction;
        const bool narrow = gate <= settings.finalDistance && angle <= settings.finalAngle;
        if (narrow && step.translation().norm() < 1e-5 && std::abs(step.sin()) < 1e-6)
            break;
        gate = std::max(settings.finalDistance, gate * settings.gateFactor);
        angle = std::max(settings.finalAngle, angle * settings.gateFactor);
    }
    choosePairs(correction, settings.finalDistance, settings.finalAngle);
    return correction;
}

VECTORLIB_BODY void CorrespondenceTracker::choosePairs(const Transformation2D &correction, double gate,
                                                       double angle) {
    pairs_.clear();
    const double cosine = std::cos(angle);
    int current = -1;
    double nearest = 0;
    LineSegment2D<double> moved;
    for (const CorrespondencePair &c : candidates_) { // sorted by dynamic edge
        if (c.moving != current) {
            current = c.moving;
            moved = correction * movingOf(c).segment;
            nearest = gate * gate;
        }
        const LineSegment2D<double> &fixed = fixedOf(c);
        if (fixed.direction().dot(moved.direction()) < cosine)
            continue;
        const double distance = fixed.meanSquareAcross(moved);
        if (distance > nearest ||
            fixed.overlap(moved) < settings.minOverlap * std::min(fixed.length(), moved.length()))
            continue;
        nearest = distance;
        if (!pairs_.empty() && pairs_.back().moving == c.moving)
            pairs_.back().fixed = c.fixed;
        else
            pairs_.push_back(c);
    }
}

VECTORLIB_BODY Transformation2D CorrespondenceTracker::refine(const Transformation2D &correction) {
    const double xy = settings.pointDeviation / settings.expectedDeviationXY;
    const double alpha = settings.pointDeviation / settings.expectedDeviationAlpha;
    refinement_.start(xy * xy, alpha * alpha);
    for (const CorrespondencePair &p : pairs_)
        refinement_.add(fixedOf(p), correction * movingOf(p).sums, 1.0);
    return refinement_.step();
}

VECTORLIB_BODY double CorrespondenceTracker::score(const Transformation2D &correction) const {
    double sum = 0;
    for (const CorrespondencePair &p : pairs_) {
        const LineSegment2D<double> moved = correction * movingOf(p).segment;
        const double distance = fixedOf(p).meanSquareAcross(moved);
        sum += fixedOf(p).overlap(moved) * (1 - distance / (settings.finalDistance * settings.finalDistance));
    }
    const double xy = correction.translation().norm() / settings.expectedDeviationXY;
    const double alpha = correction.alpha() / settings.expectedDeviationAlpha;
    return sum - settings.expectationScore * (xy * xy + alpha * alpha);
}

VECTORLIB_BODY void CorrespondenceTracker::conclude(const Transformation2D &expected,
                                                    const Transformation2D &correction) {
    Match &m = match_;
    m.pose = expected * correction;
    m.pairs = bestPairs_;
    m.matchedLength = m.visibleLength = 0;
    for (const EdgeRaw2D &edge : *moving_)
        m.visibleLength += edge.segment.length();
    registration_.clear();
    refinement_.start(0, 0);
    double squares = 0, points = 0;
    for (const CorrespondencePair &p : m.pairs) {
        const LineSegment2D<double> &fixed = fixedOf(p), &moving = movingOf(p).segment;
        m.matchedLength += moving.length();
        registration_.add(fixed, moving, std::min(fixed.length(), moving.length()));
        const EdgeRaw2D moved = correction * movingOf(p);
        squares += moved.sums.n * fixed.meanSquareAcross(moved.segment);
        points += moved.sums.n;
        refinement_.add(fixed, moved.sums, 1 / (settings.pointDeviation * settings.pointDeviation));
    }
    m.rms = points > 0 ? std::sqrt(squares / points) : 0;
    m.reliability = registration_.reliability();
    m.ambiguity = registration_.ambiguity(correction).total();
    m.accepted = m.pairs.size() >= settings.minPairs &&
                 m.matchedLength >= settings.minMatchedShare * m.visibleLength &&
                 std::abs(correction.x()) <= settings.permitted.dx &&
                 std::abs(correction.y()) <= settings.permitted.dy &&
                 std::abs(correction.alpha()) <= settings.permitted.dalpha;
    Eigen::Matrix3d toMap = Eigen::Matrix3d::Identity();
    toMap.topLeftCorner<2, 2>() << expected.cos(), -expected.sin(), expected.sin(), expected.cos();
    m.information = product(toMap, refinement_.information(), toMap);
}

} // namespace vectorlib
