#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/places/PlaceIndex.h"
#include "vectorlib/places/PlaceScan.h"
#include "vectorlib/places/ScanObjects.h"
#include "vectorlib/places/WallTiles.h"

#include <algorithm>
#include <cstdint>
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
    std::size_t mostWalls = 5; ///< that are slid while no pose is good
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
            if (number++ >= (best_ >= good ? fewWalls : mostWalls))
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
    static constexpr std::size_t mostPoints = 64; // that are looked up
    static constexpr std::size_t room = 4096;     // for poses that are not yet told apart
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

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/places/PlaceProposals.cpp")
