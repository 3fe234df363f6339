#include "vectorlib/places/PlaceSearch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

namespace vectorlib {

VECTORLIB_BODY void PlaceProposals::begin(const PlaceScan &scan) {
    found_.clear();
    least_ = best_ = 0;
    parts_ = searched_ = 0;
    few_.clear();
    // Every 27th, so that the first ones are from all over the scan.
    const std::size_t all = scan.points().size();
    for (std::size_t k = 0; k < maxPoints; ++k)
        if (const std::size_t i = k * 27 % maxPoints; i < all)
            few_.push_back(scan.points()[all > maxPoints ? i * all / maxPoints : i]);
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

VECTORLIB_BODY const Relocalized &PlaceSearch::operator()(const std::vector<MapEdge> &slots,
                                                          const std::vector<EdgeRaw2D> &edges,
                                                          PointSpan<float> points) {
    const auto begin = Clock::now();
    const auto end = begin + std::chrono::duration_cast<Clock::duration>(
                                 std::chrono::duration<double>(std::clamp(maxSeconds, 0.0, 1e6)));
    // As often as it is asked whether it is late.
    const std::size_t steps = slots.size() / 64 + propose.maxWalls * slots.size() / 16;
    std::size_t asked = 0;
    const auto isLate = [&, end] {
        if (progress)
            progress(std::min(++asked, steps), steps);
        return Clock::now() >= end;
    };
    result_.places.clear();
    result_.alike = result_.parts = result_.searched = 0;
    scan.take(edges, points);
    if (slots.empty())
        result_.outcome = Relocalized::Outcome::NoMap;
    else if (scan.walls().size() < 2 || scan.points().empty())
        result_.outcome = Relocalized::Outcome::TooLittle; // before a large map is indexed for nothing
    else if (!index_.follow(slots, isLate)) {
        result_.outcome = Relocalized::Outcome::Unfinished;
        result_.parts = slots.size();
    } else if (index_.size() == 0)
        result_.outcome = Relocalized::Outcome::NoMap;
    else
        search(isLate);
    result_.ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    return result_;
}

VECTORLIB_BODY PlaceFit PlaceSearch::judge(const std::vector<MapEdge> &slots,
                                           const std::vector<EdgeRaw2D> &edges, PointSpan<float> points,
                                           const Transformation2D &pose, const PlaceFitter &by) {
    scan.take(edges, points);
    index_.follow(slots);
    return by.judge(index_.tiles(), scan.points(), pose, 1, true, scan.wallOfPoint());
}

VECTORLIB_BODY std::optional<double> PlaceSearch::slide(const std::vector<MapEdge> &slots,
                                                        const std::vector<EdgeRaw2D> &edges,
                                                        PointSpan<float> points, const Transformation2D &pose,
                                                        Vector2D<double> along) {
    constexpr int most = int(farthestSlide / slideStep + 0.5), same = 3; // steps
    scan.take(edges, points);
    index_.follow(slots);
    const auto fitAt = [&](int k, bool looksThrough) {
        const Vector2D<double> at = pose.translation() + along * (slideStep * k);
        return fit.judge(index_.tiles(), scan.points(), {at.x, at.y, pose.alpha()}, 1, looksThrough,
                         scan.wallOfPoint());
    };
    std::array<double, 2 * most + 1> scores{};
    for (int k = -most; k <= most; ++k)
        scores[std::size_t(k + most)] = fitAt(k, false).score();
    const int best = int(std::max_element(scores.begin(), scores.end()) - scores.begin()) - most;
    const double rival = scores[std::size_t(best + most)] - clearLead;
    for (int k = -most; k <= most; ++k)
        if (std::abs(k - best) > same && scores[std::size_t(k + most)] > rival)
            return std::nullopt;
    if (most - std::abs(best) < same) // a better one may be farther away
        return std::nullopt;
    if (scores[most] > rival)
        return 0;
    const bool isBetter = fitAt(best, true).against() + clearLead < fitAt(0, true).against();
    return isBetter ? std::optional(slideStep * best) : std::nullopt;
}

template <typename IsLate>
void PlaceSearch::search(IsLate isLate) {
    refine(propose(index_, scan, isLate));
    result_.parts = propose.parts() + index_.leftOut();
    result_.searched = propose.searched();
    result_.outcome = judge();
}

VECTORLIB_BODY void PlaceSearch::refine(const std::vector<PlaceProposal> &proposals) {
    fits_.clear();
    for (const PlaceProposal &p : proposals)
        take(p.pose, 32, 4, 0.35, false);
    again(rivalLead, 16, 80, 0.25);
    again(rivalLead, 6, scan.points().size(), 0.2);
}

VECTORLIB_BODY void PlaceSearch::again(double lead, std::size_t few, std::size_t points, double gate) {
    rough_.swap(fits_);
    fits_.clear();
    for (std::size_t i = 0; i < rough_.size(); ++i)
        if (i < few || (i < maxPlaces && rough_[i].score() > rough_.front().score() - lead))
            take(rough_[i].pose, points, 5, gate, true);
}

VECTORLIB_BODY void PlaceSearch::take(const Transformation2D &pose, std::size_t points, int iterations,
                                      double gate, bool looks) {
    const WallTiles &tiles = index_.tiles();
    const std::size_t sample =
        std::max<std::size_t>(1, scan.points().size() / std::max<std::size_t>(1, points));
    const PlaceFit found =
        fit.judge(tiles, scan.points(), fit.refine(tiles, scan.points(), pose, sample, iterations, gate),
                  sample, looks, scan.wallOfPoint());
    if (!found.pose.isFinite())
        return;
    const auto known = std::find_if(fits_.begin(), fits_.end(), [&](const PlaceFit &f) {
        const Transformation2D way = f.pose.inverse() * found.pose;
        return way.translation().norm() < samePlace && std::abs(way.alpha()) < sameHeading;
    });
    if (known != fits_.end()) {
        if (!isBetter(found, *known))
            return;
        fits_.erase(known);
    }
    fits_.insert(std::upper_bound(fits_.begin(), fits_.end(), found, isBetter), found);
}

VECTORLIB_BODY Relocalized::Outcome PlaceSearch::judge() {
    if (fits_.empty())
        return result_.searched < result_.parts ? Relocalized::Outcome::Unfinished
                                                : Relocalized::Outcome::Nowhere;
    const double none = weigh(), places = std::accumulate(odds_.begin(), odds_.end(), 0.0);
    const double all = places + none;
    const auto isAlike = [this](double odds) { return odds > 1 - minProbability; };
    const bool isFixed = fits_.front().reliability() >= minReliability;
    const bool isFound = isFixed && 1 >= minProbability * all;
    result_.alike = std::size_t(std::count_if(odds_.begin(), odds_.end(), isAlike));
    const bool isOneOf = isFixed && result_.alike > 1 && places >= minSeveral * all;
    for (std::size_t i = 0; i < fits_.size() && i < maxPlaces; ++i) {
        result_.places.push_back(placeOf(fits_[i], odds_[i] / all, leads_[i]));
        result_.places.back().fault = isFound && i == 0              ? PlaceFault::None
                                      : isOneOf && isAlike(odds_[i]) ? PlaceFault::Alike
                                                                     : faultOf(fits_[i]);
    }
    if (isOneOf)
        return Relocalized::Outcome::Ambiguous;
    if (result_.searched < result_.parts)
        return Relocalized::Outcome::Unfinished;
    return isFound ? Relocalized::Outcome::Found : Relocalized::Outcome::Nowhere;
}

VECTORLIB_BODY double PlaceSearch::weigh() {
    const PlaceFit &best = fits_.front();
    leads_.assign(1, best.leadOver({}));
    odds_.assign(1, 1.0);
    for (std::size_t i = 1; i < fits_.size(); ++i) {
        leads_.push_back(best.leadOver(fits_[i]));
        leads_.front() = std::min(leads_.front(), leads_.back());
        odds_.push_back(trust.oddsOfRival(best.score(), leads_.back()));
    }
    return trust.oddsOfNone(best.score(), leads_.front());
}

VECTORLIB_BODY Place PlaceSearch::placeOf(const PlaceFit &f, double probability, double lead) {
    Place place;
    place.pose = f.pose.pose();
    place.score = f.score();
    place.probability = probability;
    place.lead = lead;
    place.reliability = f.reliability();
    place.ambiguity = f.meanSquare();
    place.discrepancy = f.discrepancy;
    place.matchedShare = f.explainedShare();
    place.against = f.against();
    place.covariance = f.covariance();
    return place;
}

VECTORLIB_BODY PlaceFault PlaceSearch::faultOf(const PlaceFit &f) const {
    if (f.reliability() < minReliability)
        return PlaceFault::Reliability;
    if (f.explainedShare() < 0.7)
        return PlaceFault::Explained;
    return f.hiddenShare() > 0.2 ? PlaceFault::Contradicted : PlaceFault::Doubtful;
}

} // namespace vectorlib
