#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/places/PlaceFitter.h"
#include "vectorlib/places/PlaceIndex.h"
#include "vectorlib/places/Relocalized.h"
#include "vectorlib/places/WallTiles.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace vectorlib {

/// A pose where a scan may fit, and how many of its points would lie beside walls that face alike.
struct PlaceProposal {
    Transformation2D pose;
    double share = 0; ///< of the points that were looked at, in [0, 1]
};

/// Proposes places for a scan: its longest walls are laid upon every wall of the map that is not much shorter
/// and slid along it, and a few points of the scan are looked up in the map's cells. Most poses are given up
/// after four points. A wall tells the heading and the place across it, so that a scan without corners is
/// found as well. Keeps its buffers.
class PlaceProposals {
public:
    double lengthShare = 0.6;  ///< of the scan's wall, that a wall of the map must have
    double overhang = 0.5;     ///< of the shorter wall beyond the longer one, at least; metres
    double step = 0.25;        ///< along the wall; metres
    std::size_t fewWalls = 2;  ///< of the scan that are slid in any case
    std::size_t maxWalls = 5;  ///< that are slid while no pose is good
    double good = 0.75;        ///< share of such a pose
    double worse = 0.35;       ///< than the best: proposals that are left out; share
    std::size_t most = 48;     ///< proposals
    double apart = 0.4;        ///< of proposals, unless they are turned; metres
    double turnedApart = 0.17; ///< radians

    /// Best first; valid until the next call. Ends early when isLate() says so.
    template <typename IsLate>
    const std::vector<PlaceProposal> &operator()(PlaceIndex &index, const PlaceScan &scan, IsLate isLate) {
        begin(scan);
        std::size_t number = 0;
        for (const LineSegment2D<double> &wall : scan.walls()) {
            if (number++ >= (best_ >= good ? fewWalls : maxWalls))
                break;
            const std::size_t all = index.size() - index.leftOut();
            parts_ += all;
            order(wall);
            std::size_t slid = 0;
            if (!index.forEachWall(lengthShare * wall.length(), [&](const LineSegment2D<double> &known) {
                    slide(index.tiles(), known, wall);
                    return ++slid % 16 != 0 || !isLate();
                })) {
                searched_ += std::min(slid, all - 1);
                break;
            }
            searched_ += all;
        }
        spread();
        return proposals_;
    }
    /// Pairs of a wall of the scan and one of the map that there were, and that were searched.
    std::size_t parts() const { return parts_; }
    std::size_t searched() const { return searched_; }

private:
    using Vector = Vector2D<double>;
    static constexpr std::size_t maxPoints = 64; // that are looked up
    static constexpr std::size_t room = 4096;    // for poses that are not yet told apart
    struct Turned {
        Vector position;
        std::uint8_t facing;
    };

    void begin(const PlaceScan &scan);
    // Last the points on the wall that is slid: they lie well anywhere along it.
    void order(const LineSegment2D<double> &wall);
    // As far as the shorter wall lies on the longer one, but for an overhang.
    void slide(WallTiles &tiles, const LineSegment2D<double> &known, const LineSegment2D<double> &wall);
    Vector turn(Vector v) const { return {cos_ * v.x - sin_ * v.y, sin_ * v.x + cos_ * v.y}; }
    // The points turned so, as far as they are needed.
    const Turned &turned(std::size_t i);
    void consider(WallTiles &tiles, Vector at);
    // In an order that does not depend on that of the walls.
    static bool isBetter(const PlaceProposal &a, const PlaceProposal &b);
    void prune();
    // The best of those that are close together.
    void spread();

    std::vector<WallPoint> few_, onWall_;
    std::vector<Turned> turned_;
    double cos_ = 1, sin_ = 0;
    std::vector<PlaceProposal> found_, proposals_;
    double least_ = 0, best_ = 0;
    std::size_t parts_ = 0, searched_ = 0;
};

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
    /// How the scan lies in the map at a pose, whatever other places there are, by the measure `by`.
    PlaceFit judge(const std::vector<MapEdge> &slots, const std::vector<EdgeRaw2D> &edges,
                   PointSpan<float> points, const Transformation2D &pose, const PlaceFitter &by);
    /// How far along a direction (of unit length) from a pose the scan lies clearly better than anywhere else
    /// within `farthestSlide`; metres. Nothing where no place there is clearly the best: lines alone look
    /// the same all along a corridor, their ends do not.
    std::optional<double> slide(const std::vector<MapEdge> &slots, const std::vector<EdgeRaw2D> &edges,
                                PointSpan<float> points, const Transformation2D &pose,
                                Vector2D<double> along);
    PlaceIndex &index() { return index_; }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr double farthestSlide = 3, slideStep = 0.1; // metres
    static constexpr double clearLead = 0.015; // of the best place along a direction, in PlaceFit::score
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
