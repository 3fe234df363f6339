#include "vectorlib/places/PlaceProposals.h"

#include "vectorlib/places/Facing.h"

#include <iterator>

namespace vectorlib {

VECTORLIB_BODY void PlaceProposals::begin(const PlaceScan &scan) {
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

VECTORLIB_BODY void PlaceProposals::order(const LineSegment2D<double> &wall) {
    onWall_.clear();
    const auto isOnWall = [&wall](const WallPoint &p) {
        return std::abs(wall.across(Vector(p.position))) <= WallTiles::beside &&
               wall.direction().dot(Vector(p.direction)) >= 0.9;
    };
    std::copy_if(few_.begin(), few_.end(), std::back_inserter(onWall_), isOnWall);
    few_.erase(std::remove_if(few_.begin(), few_.end(), isOnWall), few_.end());
    few_.insert(few_.end(), onWall_.begin(), onWall_.end());
}

VECTORLIB_BODY void PlaceProposals::slide(WallTiles &tiles, const LineSegment2D<double> &known,
                                          const LineSegment2D<double> &wall) {
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

VECTORLIB_BODY const PlaceProposals::Turned &PlaceProposals::turned(std::size_t i) {
    while (turned_.size() <= i) {
        const WallPoint &p = few_[turned_.size()];
        turned_.push_back({turn(Vector(p.position)), facingBit(turn(Vector(p.direction)))});
    }
    return turned_[i];
}

VECTORLIB_BODY void PlaceProposals::consider(WallTiles &tiles, Vector at) {
    const std::size_t n = few_.size();
    int hits = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Turned &p = turned(i);
        hits += tiles.shows(at + p.position, p.facing);
        if ((i == 3 && hits == 0) || (i == 7 && hits < 2) || (i == 15 && hits < 5) || (i == 31 && hits < 12))
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

VECTORLIB_BODY bool PlaceProposals::isBetter(const PlaceProposal &a, const PlaceProposal &b) {
    if (a.share != b.share)
        return a.share > b.share;
    return a.pose.x() != b.pose.x() ? a.pose.x() < b.pose.x() : a.pose.y() < b.pose.y();
}

VECTORLIB_BODY void PlaceProposals::prune() {
    std::nth_element(found_.begin(), found_.begin() + room / 2, found_.end(), isBetter);
    found_.resize(room / 2);
    for (const PlaceProposal &p : found_)
        least_ = &p == &found_.front() ? p.share : std::min(least_, p.share);
}

VECTORLIB_BODY void PlaceProposals::spread() {
    std::sort(found_.begin(), found_.end(), isBetter);
    proposals_.clear();
    const double cosine = std::cos(turnedApart);
    for (const PlaceProposal &p : found_) {
        if (proposals_.size() >= most || p.share < best_ - worse)
            break;
        const bool isNew = std::none_of(proposals_.begin(), proposals_.end(), [&](const PlaceProposal &o) {
            return (o.pose.translation() - p.pose.translation()).squaredNorm() < apart * apart &&
                   o.pose.cos() * p.pose.cos() + o.pose.sin() * p.pose.sin() > cosine;
        });
        if (isNew)
            proposals_.push_back(p);
    }
}

} // namespace vectorlib
