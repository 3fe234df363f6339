#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/mapping/VectorMap.h"
#include "vectorlib/observation/Observer.h"
#include "vectorlib/places/PlaceFitter.h"
#include "vectorlib/places/PlaceSearch.h"
#include "vectorlib/places/Relocalized.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

#include <functional>
#include <vector>

namespace vectorlib {

/// Adds a map, moved, to another one: walls that both have become one by their sums, their observations are
/// added, and the others are new. Walls farther apart than `distance` (root mean square, metres) stay two.
void mergeMap(VectorMap &map, const std::vector<MapEdge> &added, const Transformation2D &motion,
              double distance = 0.10);

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
    MapOverlap operator()(VectorMap &fixed, const std::vector<MapEdge> &moving, Transformation2D motion);

private:
    void collect(VectorMap &fixed, const std::vector<MapEdge> &moving, const Transformation2D &motion,
                 double gate, double turn);
    // Mean square distance of the part that lies beside the other; m^2.
    static double apart(const LineSegment2D<double> &known, const LineSegment2D<double> &wall) {
        const double t0 = wall.along(known.begin()), t1 = wall.along(known.end());
        return known.meanSquareAcross(
            wall.part(std::max(0.0, std::min(t0, t1)), std::min(wall.length(), std::max(t0, t1))));
    }
    // Walls are registered in a frame in their middle, where an error of the angle is none of the position.
    LineSegmentRegistration registration(Vector2D<double> middle) const;
    Vector2D<double> middle() const;
    Transformation2D improved(const Transformation2D &motion) const {
        const Vector2D<double> m = middle();
        const Transformation2D step = registration(m).transformation();
        return Transformation2D(m.x, m.y, 0) * step * Transformation2D(-m.x, -m.y, 0) * motion;
    }
    MapOverlap judge(const Transformation2D &motion) const;

    std::vector<SegmentPair> pairs_; // both in the frame of the fixed map; weighted by their overlap
};

/// How the search of one map in another ended.
struct MapAlignment {
    enum class Outcome {
        Found,       ///< places agree, and nothing speaks against them
        Nowhere,     ///< too few places of the second map were found in the first
        Ambiguous,   ///< places agree on different motions
        Contradicted ///< walls of the first map stand where the second one is seen through
    };
    Outcome outcome = Outcome::Nowhere;
    MapOverlap overlap;
    std::size_t places = 0;  ///< of the second map, from which much is seen
    std::size_t found = 0;   ///< of them, that are found in the first map and have no twin in the second
    std::size_t agree = 0;   ///< of these, with the motion
    std::size_t rival = 0;   ///< with the next best one
    std::size_t against = 0; ///< places where the first map shows something else
};

/// Finds how one map lies in another without any estimate: what would be seen of the second map from many
/// places is sought in the whole first map, and several places must agree on one motion. A place that looks
/// like another one of its own map does not count: rooms that are alike fold no map.
class MapAligner {
public:
    double spacing = 2;          ///< between places; metres
    std::size_t maxPlaces = 150; ///< spread evenly
    double reach = 10;           ///< of what is seen from a place; metres
    double leastSeen = 6;        ///< of walls from a place; metres
    std::size_t leastAgree = 3;  ///< places
    /// Two places agree when one leads to the other within this, and so much of the way between them.
    double same = 0.4, bent = 0.03;
    double sameAlpha = 0.1; ///< radians
    MapRegistration registration;
    std::function<void(std::size_t done, std::size_t all)> progress; ///< counts places that were sought

    /// Seeks the second map (`moving`) in the first (`fixed`), each in its own frame; metres. The motion
    /// takes the second into the frame of the first. `fixed` is not changed; its search keeps buffers.
    MapAlignment operator()(VectorMap &fixed, const std::vector<MapEdge> &moving);

    /// The same for a motion that is told. As it may be chosen by what a few places show, three times as many
    /// must agree as where it is found; Nowhere means that too few do, and nothing more.
    MapAlignment confirm(VectorMap &fixed, const std::vector<MapEdge> &moving, const Transformation2D &told);

private:
    static constexpr double maxHidden = 0.25, leastAlike = 0.5; // shares of what is seen from a place

    struct PlaceOfMap {
        Pose2D pose;                  // in the second map
        std::vector<EdgeRaw2D> edges; // seen from there
    };
    struct Vote {
        Pose2D pose;             // in the second map
        Transformation2D motion; // that the place tells
    };

    // In front of walls, one a square of the grid, from where enough is seen.
    void findPlaces(const std::vector<MapEdge> &map);
    double see(const std::vector<LineSegment2D<double>> &walls, PlaceOfMap &place);
    void findVotes(VectorMap &fixed, const std::vector<MapEdge> &moving);
    static const Relocalized &search(PlaceSearch &search, const std::vector<MapEdge> &map,
                                     const PlaceOfMap &place);
    bool isNear(const Transformation2D &a, const Pose2D &b, double way) const {
        const Transformation2D off = a.inverse() * Transformation2D(b);
        return off.translation().norm() <= same + bent * way && std::abs(off.alpha()) <= sameAlpha;
    }
    bool agree(const Vote &a, const Vote &b) const {
        const Transformation2D there = a.motion * Transformation2D(b.pose);
        const Transformation2D found = b.motion * Transformation2D(b.pose);
        return isNear(there, found.pose(), std::hypot(a.pose.x - b.pose.x, a.pose.y - b.pose.y));
    }
    // The one that most agree with; and how many agree with each other, and not with it.
    std::size_t bestVote(MapAlignment &result) const;
    // Least squares over the places that agree with one: they lie apart, and tell the angle better than each.
    Transformation2D motionOfAll(const Vote &best) const;
    // Places where the first map shows something else, and walls that would be looked through. Doors and
    // furniture move: places that agree, or where most is alike, are none.
    std::size_t countContradictions(const Transformation2D &motion) {
        std::size_t against = 0;
        forEachFit(motion, [&](const PlaceFit &fit) { against += isAgainst(fit); });
        return against;
    }
    static bool isAgainst(const PlaceFit &fit) {
        return fit.hiddenShare() > maxHidden && fit.explainedShare() < leastAlike;
    }
    template <typename Take>
    void forEachFit(const Transformation2D &motion, Take take) {
        for (const PlaceOfMap &place : places_) {
            inFixed_.scan.take(place.edges, {});
            take(inFixed_.fit.judge(inFixed_.index().tiles(), inFixed_.scan.points(),
                                    motion * Transformation2D(place.pose), 1, true,
                                    inFixed_.scan.wallOfPoint()));
        }
    }

    Observer<double> observe_;
    PlaceSearch inFixed_, inMoving_;
    std::vector<PlaceOfMap> places_;
    std::vector<Vote> votes_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/MapAligner.cpp")
