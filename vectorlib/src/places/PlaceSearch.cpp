#include "vectorlib/places/PlaceSearch.h"

#include <numeric>

namespace vectorlib {

VECTORLIB_BODY const Relocalized &PlaceSearch::operator()(const std::vector<MapEdge> &slots,
                                                          const std::vector<EdgeRaw2D> &edges,
                                                          PointSpan<float> points) {
    const auto begin = Clock::now();
    const auto end = begin + std::chrono::duration_cast<Clock::duration>(
                                 std::chrono::duration<double>(std::clamp(maxSeconds, 0.0, 1e6)));
    // As often as it is asked whether it is late.
    const std::size_t steps = slots.size() / 64 + propose.mostWalls * slots.size() / 16;
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
