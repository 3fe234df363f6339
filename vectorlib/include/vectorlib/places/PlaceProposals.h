#pragma once

#include "vectorlib/places/PlaceIndex.h"
#include "vectorlib/places/PlaceScan.h"

#include <iterator>

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

    void begin(const PlaceScan &scan) {
        found_.clear();
        least_ = best_ = 0;
        parts_ = searched_ = 0;
        few_.clear();
        // Every 27th, so that the first ones are from all over the scan.
        const std::size_t all = scan.points().size();
        for (std::size_t k = 0; k < mostPoints; ++k)
            if (const std::size_t i = k * 27 % mostPoints; i < all)
                few_.push_back(scan.points()[all > mostPoints ? i * all / mostPoints : i]);
    }
    // Last the points on the wall that is slid: they lie well anywhere along it.
    void order(const LineSegment2D<double> &wall) {
        onWall_.clear();
        const auto isOnWall = [&wall](const WallPoint &p) {
            return std::abs(wall.across(Vector(p.position))) <= WallTiles::beside &&
                   wall.direction().dot(Vector(p.direction)) >= 0.9;
        };
        std::copy_if(few_.begin(), few_.end(), std::back_inserter(onWall_), isOnWall);
        few_.erase(std::remove_if(few_.begin(), few_.end(), isOnWall), few_.end());
        few_.insert(few_.end(), onWall_.begin(), onWall_.end());
    }
    // As far as the shorter wall lies on the longer one, but for an overhang.
    void slide(WallTiles &tiles, const LineSegment2D<double> &known, const LineSegment2D<double> &wall) {
        cos_ = wall.direction().dot(known.direction());
        sin_ = wall.direction().cross(known.direction());
        turned_.clear();
        const double shorter = std::min(known.length(), wall.length());
        const double reach = std::max(shorter / 4, std::abs(known.length() - wall.length()) / 2 + overhang);
        const double steps = std::ceil(2 * reach / step);
        const Vector start = known.middle() - turn(wall.middle());
        for (double k = 0; k <= steps; ++k)
            consider(tiles, start + known.direction() * (reach * (2 * k / steps - 1)));
    }
    Vector turn(Vector v) const { return {cos_ * v.x - sin_ * v.y, sin_ * v.x + cos_ * v.y}; }
    // The points turned so, as far as they are needed.
    const Turned &turned(std::size_t i) {
        while (turned_.size() <= i) {
            const WallPoint &p = few_[turned_.size()];
            turned_.push_back({turn(Vector(p.position)), facingBit(turn(Vector(p.direction)))});
        }
        return turned_[i];
    }
    void consider(WallTiles &tiles, Vector at) {
        const std::size_t n = few_.size();
        int hits = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const Turned &p = turned(i);
            hits += tiles.shows(at + p.position, p.facing);
            if ((i == 3 && hits == 0) || (i == 7 && hits < 2) || (i == 15 && hits < 5) ||
                (i == 31 && hits < 12))
                return;
        }
        const double share = double(hits) / double(std::max<std::size_t>(1, n));
        if (share < least_)
            return;
        best_ = std::max(best_, share);
        found_.push_back({Transformation2D(at.x, at.y, std::atan2(sin_, cos_)), share});
        if (found_.size() >= room)
            prune();
    }
    // In an order that does not depend on that of the walls.
    static bool isBetter(const PlaceProposal &a, const PlaceProposal &b) {
        if (a.share != b.share)
            return a.share > b.share;
        return a.pose.x() != b.pose.x() ? a.pose.x() < b.pose.x() : a.pose.y() < b.pose.y();
    }
    void prune() {
        std::nth_element(found_.begin(), found_.begin() + room / 2, found_.end(), isBetter);
        found_.resize(room / 2);
        for (const PlaceProposal &p : found_)
            least_ = &p == &found_.front() ? p.share : std::min(least_, p.share);
    }
    // The best of those that are close together.
    void spread() {
        std::sort(found_.begin(), found_.end(), isBetter);
        proposals_.clear();
        const double cosine = std::cos(turnedApart);
        for (const PlaceProposal &p : found_) {
            if (proposals_.size() >= most || p.share < best_ - worse)
                break;
            const bool isNew =
                std::none_of(proposals_.begin(), proposals_.end(), [&](const PlaceProposal &o) {
                    return (o.pose.translation() - p.pose.translation()).squaredNorm() < apart * apart &&
                           o.pose.cos() * p.pose.cos() + o.pose.sin() * p.pose.sin() > cosine;
                });
            if (isNew)
                proposals_.push_back(p);
        }
    }

    std::vector<WallPoint> few_, onWall_;
    std::vector<Turned> turned_;
    double cos_ = 1, sin_ = 0;
    std::vector<PlaceProposal> found_, proposals_;
    double least_ = 0, best_ = 0;
    std::size_t parts_ = 0, searched_ = 0;
};

} // namespace vectorlib
