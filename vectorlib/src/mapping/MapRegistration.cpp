#include "vectorlib/mapping/MapRegistration.h"

namespace vectorlib {

VECTORLIB_BODY MapOverlap MapRegistration::operator()(VectorMap &fixed, const std::vector<MapEdge> &moving,
                                                      Transformation2D motion) {
    MapOverlap overlap;
    for (int step = 0; step <= steps; ++step) {
        const double share = std::min(1.0, 2.0 * step / steps);
        collect(fixed, moving, motion, firstGate + share * (lastGate - firstGate),
                firstTurn + share * (lastTurn - firstTurn));
        overlap = judge(motion);
        if (step < steps && overlap.reliability > 0)
            motion = improved(motion);
    }
    return overlap;
}

VECTORLIB_BODY void MapRegistration::collect(VectorMap &fixed, const std::vector<MapEdge> &moving,
                                             const Transformation2D &motion, double gate, double turn) {
    pairs_.clear();
    for (const MapEdge &edge : moving) {
        const LineSegment2D<double> wall = motion * edge.segment;
        const std::size_t first = pairs_.size();
        double covered = 0;
        for (const int number : fixed.near(wall, gate)) {
            const LineSegment2D<double> &known = fixed.slots()[std::size_t(number)].segment;
            const double overlap = known.overlap(wall);
            const bool isAlike = known.direction().dot(wall.direction()) > std::cos(turn);
            if (isAlike && overlap >= leastOverlap && apart(known, wall) <= gate * gate) {
                pairs_.push_back({known, wall, overlap});
                covered += overlap;
            }
        }
        for (std::size_t i = first; i < pairs_.size(); ++i) // those that lie beside each other share it
            pairs_[i].weight *= std::min(1.0, wall.length() / covered);
    }
}

VECTORLIB_BODY double MapRegistration::apart(const LineSegment2D<double> &known,
                                             const LineSegment2D<double> &wall) {
    const double t0 = wall.along(known.begin()), t1 = wall.along(known.end());
    return known.meanSquareAcross(
        wall.part(std::max(0.0, std::min(t0, t1)), std::min(wall.length(), std::max(t0, t1))));
}

VECTORLIB_BODY LineSegmentRegistration MapRegistration::registration(Vector2D<double> middle) const {
    const Transformation2D toMiddle(-middle.x, -middle.y, 0);
    LineSegmentRegistration all;
    for (const SegmentPair &pair : pairs_)
        all.add(toMiddle * pair.fixed, toMiddle * pair.moving, pair.weight);
    return all;
}

VECTORLIB_BODY Vector2D<double> MapRegistration::middle() const {
    Vector2D<double> sum;
    double weight = 0;
    for (const SegmentPair &pair : pairs_) {
        sum += pair.moving.middle() * pair.weight;
        weight += pair.weight;
    }
    return weight > 0 ? sum * (1 / weight) : sum;
}

VECTORLIB_BODY Transformation2D MapRegistration::improved(const Transformation2D &motion) const {
    const Vector2D<double> m = middle();
    const Transformation2D step = registration(m).transformation();
    return Transformation2D(m.x, m.y, 0) * step * Transformation2D(-m.x, -m.y, 0) * motion;
}

VECTORLIB_BODY MapOverlap MapRegistration::judge(const Transformation2D &motion) const {
    MapOverlap overlap{motion, 0, 0, registration(middle()).reliability()};
    double squares = 0;
    for (const SegmentPair &pair : pairs_) {
        overlap.length += pair.weight;
        squares += pair.weight * apart(pair.fixed, pair.moving);
    }
    overlap.rms = overlap.length > 0 ? std::sqrt(squares / overlap.length) : 0;
    return overlap;
}

} // namespace vectorlib
