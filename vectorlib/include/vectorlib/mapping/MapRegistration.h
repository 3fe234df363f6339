#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/MapEdge.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/SegmentPair.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/mapping/VectorMap.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

#include <vector>

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
    MapOverlap operator()(VectorMap &fixed, const std::vector<MapEdge> &moving, Transformation2D motion);

private:
    void collect(VectorMap &fixed, const std::vector<MapEdge> &moving, const Transformation2D &motion,
                 double gate, double turn);
    // Mean square distance of the part that lies beside the other; m^2.
    static double apart(const LineSegment2D<double> &known, const LineSegment2D<double> &wall);
    // Walls are registered in a frame in their middle, where an error of the angle is none of the position.
    LineSegmentRegistration registration(Vector2D<double> middle) const;
    Vector2D<double> middle() const;
    Transformation2D improved(const Transformation2D &motion) const;
    MapOverlap judge(const Transformation2D &motion) const;

    std::vector<SegmentPair> pairs_; // both in the frame of the fixed map; weighted by their overlap
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/MapRegistration.cpp")
