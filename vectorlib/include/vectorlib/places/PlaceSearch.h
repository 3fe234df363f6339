#pragma once

#include "vectorlib/places/PlaceFitter.h"
#include "vectorlib/places/PlaceProposals.h"
#include "vectorlib/places/Relocalized.h"

#include <chrono>

namespace vectorlib {

/// How probable it is that a place is the right one, learned from scans of real and made-up buildings in maps
/// of the same and of other buildings: logistic in the score, its lead over the next place, the share of
/// points that lie nowhere, and the number of points.
struct PlaceTrust {
    double constant = -26.6, score = 26.2, lead = 27.7, points = 1.8, extra = 16.3;
    double mostLead = 0.3; ///< a greater one says no more

    /// Of a place that scores so much more than the next one.
    double probability(const PlaceFit &fit, double ahead) const {
        return 1 / (1 + std::exp(-evidence(fit) - lead * std::clamp(ahead, 0.0, mostLead)));
    }
    /// The lead that a place needs to be as probable as this.
    double leadFor(const PlaceFit &fit, double least) const {
        return (std::log(least / (1 - least)) - evidence(fit)) / lead;
    }

private:
    double evidence(const PlaceFit &fit) const {
        const double nowhere = 1 - fit.explainedShare() - (fit.points > 0 ? fit.blocked / fit.points : 0);
        return constant + score * fit.score() + points * std::log(std::max(1.0, fit.points) / 50) +
               extra * nowhere;
    }
};

/// Finds the place of a scan in a whole map without any expected pose: proposals by walls laid upon walls,
/// refined and judged by the scan's points. A place is found when it fits well and no other fits alike. Keeps
/// its index of the map, and its buffers, between calls.
class PlaceSearch {
public:
    double maxSeconds = 3;        ///< and the time of the last steps, a few milliseconds
    double minProbability = 0.9;  ///< of a place that is found
    double minLead = 0.04;        ///< in score; places that are nearer to the best fit alike
    double clearLead = 0.12;      ///< a place that needs no greater lead is good, whether or not others are
    double minReliability = 0.02; ///< of a place that is found
    std::size_t maxPlaces = 24;   ///< in the result
    PlaceScan scan;
    PlaceProposals propose;
    PlaceFitter fit;
    PlaceTrust trust;

    /// `slots` are those of a VectorMap; `edges` and `points` of the scan in the sensor's frame, points
    /// counter-clockwise. Without points the edges stand for them. Valid until the next call.
    const Relocalized &operator()(const std::vector<MapEdge> &slots, const std::vector<EdgeRaw2D> &edges,
                                  PointSpan<float> points) {
        const auto begin = Clock::now();
        const auto end = begin + std::chrono::duration_cast<Clock::duration>(
                                     std::chrono::duration<double>(std::clamp(maxSeconds, 0.0, 1e6)));
        const auto isLate = [end] { return Clock::now() >= end; };
        result_.places.clear();
        result_.alike = result_.parts = result_.searched = 0;
        scan.take(edges, points);
        const bool followed = index_.follow(slots, isLate);
        if (slots.empty() || (followed && index_.size() == 0))
            result_.outcome = Relocalized::Outcome::NoMap;
        else if (scan.walls().size() < 2 || scan.points().empty())
            result_.outcome = Relocalized::Outcome::TooLittle;
        else if (!followed) {
            result_.outcome = Relocalized::Outcome::Unfinished;
            result_.parts = slots.size();
        } else
            search(isLate);
        result_.ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
        return result_;
    }
    PlaceIndex &index() { return index_; }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr double samePlace = 0.5, sameHeading = 0.17; // metres, radians: found from two proposals

    template <typename IsLate>
    void search(IsLate isLate) {
        refine(propose(index_, scan, isLate));
        result_.parts = propose.parts() + index_.leftOut();
        result_.searched = propose.searched();
        result_.outcome = judge();
    }
    void refine(const std::vector<PlaceProposal> &proposals) {
        fits_.clear();
        for (const PlaceProposal &p : proposals)
            take(p.pose, 32, 4, 0.35, false);
        again(0.15, 16, 80, 0.25);
        again(0.10, 6, scan.points().size(), 0.2);
    }
    // The best so far, more exactly: those that score nearly like the first, and some more.
    void again(double lead, std::size_t few, std::size_t points, double gate) {
        rough_.swap(fits_);
        fits_.clear();
        for (std::size_t i = 0; i < rough_.size(); ++i)
            if (i < few || (i < maxPlaces && rough_[i].score() > rough_.front().score() - lead))
                take(rough_[i].pose, points, 5, gate, true);
    }
    // Refines a pose and keeps the better one of two that are the same place; best first.
    void take(const Transformation2D &pose, std::size_t points, int iterations, double gate, bool looks) {
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
    static bool isBetter(const PlaceFit &a, const PlaceFit &b) { return a.score() > b.score(); }

    Relocalized::Outcome judge() {
        if (fits_.empty())
            return result_.searched < result_.parts ? Relocalized::Outcome::Unfinished
                                                    : Relocalized::Outcome::Nowhere;
        result_.alike = countAlike(neededLead(fits_.front()));
        // A place that needs a great lead over the others says little by itself.
        const double mostNeeded = result_.alike > 1 ? clearLead : trust.mostLead;
        const bool isAccepted = isGood(fits_.front(), mostNeeded);
        const double oneOf = double(countAlike(minLead)); // one of them at most is right
        for (std::size_t i = 0; i < fits_.size() && i < maxPlaces; ++i) {
            const PlaceFit &f = fits_[i];
            const double lead = i > 0 ? 0 : fits_.size() > 1 ? f.score() - fits_[1].score() : trust.mostLead;
            const bool isToo = isAccepted && i < result_.alike && isGood(f, mostNeeded);
            result_.places.push_back(placeOf(f, trust.probability(f, lead) / oneOf));
            result_.places.back().fault = !isToo              ? faultOf(f)
                                          : result_.alike > 1 ? PlaceFault::Alike
                                                              : PlaceFault::None;
        }
        if (isAccepted && result_.alike > 1)
            return Relocalized::Outcome::Ambiguous;
        if (result_.searched < result_.parts)
            return Relocalized::Outcome::Unfinished;
        if (isAccepted)
            return Relocalized::Outcome::Found;
        result_.alike = countAlike(minLead);
        return Relocalized::Outcome::Nowhere;
    }
    bool isGood(const PlaceFit &f, double mostNeeded) const {
        return f.reliability() >= minReliability && neededLead(f) <= mostNeeded;
    }
    // Over the next place.
    double neededLead(const PlaceFit &f) const { return std::max(minLead, trust.leadFor(f, minProbability)); }
    // The first, and those that score nearly like it.
    std::size_t countAlike(double lead) const {
        return 1 + std::size_t(std::count_if(fits_.begin() + 1, fits_.end(), [&](const PlaceFit &f) {
                   return f.score() > fits_.front().score() - lead;
               }));
    }
    static Place placeOf(const PlaceFit &f, double probability) {
        Place place;
        place.pose = f.pose.pose();
        place.score = f.score();
        place.probability = probability;
        place.reliability = f.reliability();
        place.ambiguity = f.meanSquare();
        place.discrepancy = f.discrepancy;
        place.matchedShare = f.explainedShare();
        place.covariance = f.covariance();
        return place;
    }
    // Of a place that is not accepted.
    PlaceFault faultOf(const PlaceFit &f) const {
        if (f.reliability() < minReliability)
            return PlaceFault::Reliability;
        if (f.explainedShare() < 0.7)
            return PlaceFault::Explained;
        return f.hiddenShare() > 0.2 ? PlaceFault::Contradicted : PlaceFault::Doubtful;
    }

    PlaceIndex index_;
    std::vector<PlaceFit> fits_, rough_; // best first
    Relocalized result_;
};

} // namespace vectorlib
