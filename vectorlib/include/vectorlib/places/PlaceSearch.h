#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/edges/MapEdge.h"
#include "vectorlib/geometry/PointSpan.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/places/PlaceFit.h"
#include "vectorlib/places/PlaceFitter.h"
#include "vectorlib/places/PlaceIndex.h"
#include "vectorlib/places/PlaceProposals.h"
#include "vectorlib/places/PlaceScan.h"
#include "vectorlib/places/PlaceTrust.h"
#include "vectorlib/places/Relocalized.h"

#include <chrono>
#include <functional>
#include <vector>

namespace vectorlib {

/// Finds the place of a scan in a whole map without any expected pose: proposals by walls laid upon walls,
/// refined and judged by the scan's points. A place is found when several objects of the scan speak for it
/// against none and against every other place. Keeps its index of the map, and its buffers, between calls.
class PlaceSearch {
public:
    double maxSeconds = 3;        ///< and the time of the last steps, a few milliseconds
    double minProbability = 0.9;  ///< of a place that is found
    double minReliability = 0.02; ///< of a place that is found
    double minSeveral = 0.5;      ///< probability of places that fit alike, that one of them is right
    std::size_t maxPlaces = 24;   ///< in the result
    double rivalLead = 0.25;      ///< in score; places that are farther behind are no rivals
    PlaceScan scan;
    PlaceProposals propose;
    PlaceFitter fit;
    PlaceTrust trust;
    /// Steps of the search, about; it may end before all are done.
    std::function<void(std::size_t done, std::size_t all)> progress;

    /// `slots` are those of a VectorMap; `edges` and `points` of the scan in the sensor's frame, points
    /// counter-clockwise. Without points the edges stand for them. Valid until the next call.
    const Relocalized &operator()(const std::vector<MapEdge> &slots, const std::vector<EdgeRaw2D> &edges,
                                  PointSpan<float> points);
    PlaceIndex &index() { return index_; }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr double samePlace = 0.5, sameHeading = 0.17; // metres, radians: found from two proposals

    template <typename IsLate>
    void search(IsLate isLate);
    void refine(const std::vector<PlaceProposal> &proposals);
    // The best so far, more exactly: those that score nearly like the first, and some more.
    void again(double lead, std::size_t few, std::size_t points, double gate);
    // Refines a pose and keeps the better one of two that are the same place; best first.
    void take(const Transformation2D &pose, std::size_t points, int iterations, double gate, bool looks);
    static bool isBetter(const PlaceFit &a, const PlaceFit &b) { return a.score() > b.score(); }

    Relocalized::Outcome judge();
    // The odds of the places, and of none of them, to those of the first.
    double weigh();
    static Place placeOf(const PlaceFit &f, double probability, double lead);
    // Of a place that is not accepted.
    PlaceFault faultOf(const PlaceFit &f) const;

    PlaceIndex index_;
    std::vector<PlaceFit> fits_, rough_; // best first
    std::vector<double> odds_;           // of the fits, to those of the first
    std::vector<double> leads_;          // of the first over each; its own is the least
    Relocalized result_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/places/PlaceSearch.cpp")
