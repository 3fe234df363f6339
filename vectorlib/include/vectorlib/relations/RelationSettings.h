#pragma once

#include "vectorlib/geometry/Angle.h"

#include <cmath>
#include <cstddef>

namespace vectorlib {

/// Settings of RelationMatcher. The windows are those published (pose-free thesis 6.3.1).
struct RelationSettings {
    double angleWindow = 5 * pi / 180; ///< angles no farther apart are equal; radians
    double distanceWindow = 0.10;      ///< lengths and distances no farther apart are equal; metres
    /// Least merged score of a pair, as a share of the largest one. The published value is not known.
    double threshold = 0.10;
    /// The same of the searches after the first, which look for places that fewer relations tell.
    double laterThreshold = 0.02;
    /// Matching segments come in one order in both scans (5.7, Algorithm 10): for small motions.
    bool sameOrder = false;
    /// A virtual edge lies no farther from either of its segments than this many of its lengths.
    double virtualReach = 1.0;
    double virtualAngle = 25 * pi / 180; ///< least angle between the lines of a virtual edge; radians
    double leastEdgeDistance = 0.25;     ///< nearer edges have no direction worth comparing; metres
    int places = 3;                      ///< of the pairs of a search that are looked at
    /// Least length of the pairs, as a share of what the scan that sees less sees.
    double matchedShare = 0.3;
    /// Most length that stands where the other scan looked through, as a share (below 1) of the matched one.
    double seenThroughShare = 0.15;
    int leastSigns = 3; ///< that must agree at the place that is found (MatchSigns); 0: any
    /// A place elsewhere with this share of the evidence of the found one makes the match ambiguous.
    double rivalShare = 0.6;
    int searches = 20;            ///< of Algorithm 5, each without the pairs of those before; 1: as published
    double deviation = 0.06;      ///< largest standard deviation of the position; metres
    std::size_t maxSegments = 64; ///< of a scan: the longest; more are left out
    std::size_t maxVirtualEdges = 24; ///< of a scan: those known best
    std::size_t maxScores = 200000;   ///< entries of the matching table; the rest is left out
    /// Comparisons of two relations after which no other relation of the current scan is looked at; a quarter
    /// of a second, and more than 64 segments within 2 m need.
    std::size_t maxCompared = 50000000;

    bool isValid() const {
        return angleWindow > 0 && angleWindow < pi / 4 && distanceWindow > 0 &&
               std::isfinite(distanceWindow) && threshold >= 0 && threshold <= 1 && laterThreshold >= 0 &&
               virtualReach >= 0 && virtualAngle > 0 && virtualAngle < pi / 2 && leastEdgeDistance >= 0 &&
               rivalShare > 0 && leastSigns >= 0 && seenThroughShare >= 0 && seenThroughShare < 1 &&
               matchedShare >= 0 && searches >= 1 && searches <= 100 && places >= 1 && places <= 8 &&
               deviation > 0 && maxSegments <= 255 && maxVirtualEdges <= 256 && maxScores <= 10000000;
    }
};

} // namespace vectorlib
