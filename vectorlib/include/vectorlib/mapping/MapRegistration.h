#pragma once

#include "vectorlib/mapping/VectorMap.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

namespace vectorlib {

/// How far two maps show the same walls, by some motion of the second one.
struct MapOverlap {
    Transformation2D motion; ///< moves the second map onto the first
    double length = 0;       ///< of walls that both have; metres
    double rms = 0;          ///< root mean square distance of these walls from each other; metres
    double reliability = 0;  ///< in [0, 1], of the directions of these walls
};

/// Lays one map onto another, beginning nearby: walls that lie beside each other and face alike are pairs,
/// and the motion follows from all pairs in closed form, step by step nearer.
class MapRegistration {
public:
    double firstGate = 0.5, lastGate = 0.2;   ///< most distance of two walls, as maps bend; metres
    double firstTurn = 0.15, lastTurn = 0.05; ///< most angle between them; radians
    double leastOverlap = 0.2;                ///< of two walls; metres
    int steps = 16;

    /// `moving` changes no more than its motion. The first map is not const as its search keeps buffers.
    MapOverlap operator()(VectorMap &fixed, const std::vector<MapEdge> &moving, Transformation2D motion) {
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

private:
    void collect(VectorMap &fixed, const std::vector<MapEdge> &moving, const Transformation2D &motion,
                 double gate, double turn) {
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
    // Mean square distance of the part that lies beside the other; m^2.
    static double apart(const LineSegment2D<double> &known, const LineSegment2D<double> &wall) {
        const double t0 = wall.along(known.begin()), t1 = wall.along(known.end());
        return known.meanSquareAcross(
            wall.part(std::max(0.0, std::min(t0, t1)), std::min(wall.length(), std::max(t0, t1))));
    }
    // Walls are registered in a frame in their middle, where an error of the angle is none of the position.
    LineSegmentRegistration registration(Vector2D<double> middle) const {
        const Transformation2D toMiddle(-middle.x, -middle.y, 0);
        LineSegmentRegistration all;
        for (const SegmentPair &pair : pairs_)
            all.add(toMiddle * pair.fixed, toMiddle * pair.moving, pair.weight);
        return all;
    }
    Vector2D<double> middle() const {
        Vector2D<double> sum;
        double weight = 0;
        for (const SegmentPair &pair : pairs_) {
            sum += pair.moving.middle() * pair.weight;
            weight += pair.weight;
        }
        return weight > 0 ? sum * (1 / weight) : sum;
    }
    Transformation2D improved(const Transformation2D &motion) const {
        const Vector2D<double> m = middle();
        const Transformation2D step = registration(m).transformation();
        return Transformation2D(m.x, m.y, 0) * step * Transformation2D(-m.x, -m.y, 0) * motion;
    }
    MapOverlap judge(const Transformation2D &motion) const {
        MapOverlap overlap{motion, 0, 0, registration(middle()).reliability()};
        double squares = 0;
        for (const SegmentPair &pair : pairs_) {
            overlap.length += pair.weight;
            squares += pair.weight * apart(pair.fixed, pair.moving);
        }
        overlap.rms = overlap.length > 0 ? std::sqrt(squares / overlap.length) : 0;
        return overlap;
    }

    std::vector<SegmentPair> pairs_; // both in the frame of the fixed map; weighted by their overlap
};

} // namespace vectorlib
