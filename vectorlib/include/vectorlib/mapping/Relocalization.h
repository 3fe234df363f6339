#pragma once

#include "vectorlib/correspondence/CorrespondenceFinder.h"
#include "vectorlib/mapping/VectorMap.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

namespace vectorlib {

/// A place in the map where a scan fits, and what speaks for it.
struct Place {
    Pose2D pose;            ///< of the sensor in the map's frame
    double score = 0;       ///< in [0, 1]; places are ranked by it
    double reliability = 0; ///< in [0, 1]
    double ambiguity = 0;   ///< m^2
    double discrepancy = 0; ///< of what would be seen from there and what was seen; m^2
    double matchedShare = 0;
    Fault fault = Fault::None; ///< None when the place is accepted
};

/// How a search of the whole map ended.
struct Relocalized {
    enum class Outcome {
        Found,     ///< the first place fits, and no other like it
        NoScan,    ///< there is no scan yet
        NoMap,     ///< the map is empty
        TooLittle, ///< the scan has fewer than two edges
        Nowhere,   ///< no place is accepted
        Ambiguous, ///< several places fit alike
        Unfinished ///< time or a bound ended the search: parts of the map were not searched
    };
    Outcome outcome = Outcome::NoScan;
    std::vector<Place> places; ///< the best ones, best first
    std::size_t alike = 0;     ///< places that score nearly like the best
    std::size_t parts = 0;     ///< of the map
    std::size_t searched = 0;  ///< of these parts
    double ms = 0;

    bool isFound() const { return outcome == Outcome::Found; }
    /// In words, for people.
    std::string text() const {
        const auto count = [](std::size_t n) { return std::to_string(n); };
        switch (outcome) {
        case Outcome::Found:
            return "found";
        case Outcome::NoScan:
            return "no scan was taken yet";
        case Outcome::NoMap:
            return "the map is empty";
        case Outcome::TooLittle:
            return "the last scan shows fewer than two line segments";
        case Outcome::Nowhere:
            return places.empty() ? "the scan fits nowhere in the map"
                                  : std::string("no place in the map is good enough; the best: ") +
                                        describe(places.front().fault);
        case Outcome::Ambiguous:
            return count(alike) + " places in the map fit alike";
        case Outcome::Unfinished:
            return "only " + count(searched) + " of " + count(parts) + " parts of the map were searched";
        }
        return {};
    }
};

/// Finds the place of a scan in a whole map without any expected pose. The map is searched in square parts by
/// the correspondence search with any heading permitted; the parts near the last known pose come first. The
/// time is bounded; a place is found only when the whole map was searched and no other place fits like it.
class Relocalization {
public:
    double maxSeconds = 3;          ///< and the time of one part
    double minScore = 0.6;          ///< of a place that is found
    double rivalShare = 0.8;        ///< of the best score: places that score so much fit alike
    double discrepancyShare = 0.20; ///< see SearchSettings; more than there, as people and furniture move
    double part = 1.5;              ///< half side of the parts; in larger ones rivals stay unseen; metres
    std::size_t maxEdges = 12;      ///< of the scan, the longest
    std::size_t maxPlaces = 8;      ///< in the result

    /// `edges` in the sensor's frame. Valid until the next call.
    const Relocalized &operator()(const VectorMap &map, const std::vector<EdgeRaw2D> &edges,
                                  const Pose2D &lastKnown) {
        const auto begin = Clock::now();
        result_ = Relocalized();
        takeMap(map, {lastKnown.x, lastKnown.y});
        takeScan(edges);
        if (map_.size() == 0)
            result_.outcome = Relocalized::Outcome::NoMap;
        else if (scan_.size() < 2)
            result_.outcome = Relocalized::Outcome::TooLittle;
        else {
            search(begin +
                   std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(maxSeconds)));
            result_.outcome = judge();
        }
        result_.ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
        return result_;
    }

private:
    using Clock = std::chrono::steady_clock;
    using Vector = Vector2D<double>;
    // Nearer places are one, found from two parts or from other pairs.
    static constexpr SamePose samePlace{0.3, 0.1};
    static constexpr double overlap =
        0.1; // of neighbouring parts, so that no place falls between them; metres
    static constexpr std::size_t maxParts =
        1000000; // a map of 2.8 km x 2.8 km; what is beyond stays unsearched
    static constexpr std::size_t keptPlaces = 64;

    static bool isBetter(const Place &a, const Place &b) { return a.score > b.score; }

    void takeMap(const VectorMap &map, Vector lastKnown) {
        map_ = SegmentMap();
        parts_.clear();
        Vector low(INFINITY, INFINITY), high = low * -1.0;
        map.forEach([&](const MapEdge &edge) {
            map_.add(edge.segment);
            for (const Vector p : {edge.segment.begin(), edge.segment.end()}) {
                low = {std::min(low.x, p.x), std::min(low.y, p.y)};
                high = {std::max(high.x, p.x), std::max(high.y, p.y)};
            }
        });
        if (map_.size() == 0)
            return;
        const double step = 2 * (part - overlap);
        const double columns = std::max(1.0, std::ceil((high.x - low.x) / step)),
                     rows = std::max(1.0, std::ceil((high.y - low.y) / step));
        result_.parts = static_cast<std::size_t>(std::min(1e15, columns * rows));
        for (double i = 0; i < columns && parts_.size() < maxParts; ++i)
            for (double j = 0; j < rows && parts_.size() < maxParts; ++j)
                parts_.push_back(low + Vector(i + 0.5, j + 0.5) * step);
        const auto isNearer = [lastKnown](Vector a, Vector b) {
            return (a - lastKnown).squaredNorm() < (b - lastKnown).squaredNorm();
        };
        if (lastKnown.isFinite())
            std::stable_sort(parts_.begin(), parts_.end(), isNearer);
    }
    void takeScan(const std::vector<EdgeRaw2D> &edges) {
        scan_.clear();
        for (const EdgeRaw2D &edge : edges)
            scan_.push_back(edge.segment);
        std::stable_sort(scan_.begin(), scan_.end(),
                         [](const auto &a, const auto &b) { return a.length() > b.length(); });
        if (scan_.size() > maxEdges)
            scan_.erase(scan_.begin() + std::ptrdiff_t(maxEdges), scan_.end());
    }
    void search(Clock::time_point end) {
        find_.settings.permitted = {part, part, pi};
        find_.settings.discrepancyShare = discrepancyShare;
        for (const Vector middle : parts_) {
            if (Clock::now() >= end)
                break;
            const SearchResult &found = find_(map_, scan_, Transformation2D(middle.x, middle.y, 0));
            for (const Solution &solution : found.solutions)
                take(solution);
            if (found.outcome != SearchOutcome::TooManyPairs)
                ++result_.searched;
        }
    }
    // Keeps the places best first.
    void take(const Solution &s) {
        if (s.fault == Fault::NotPermitted || s.fault == Fault::NoEvidence) // found better from another part
            return;
        const Place place{s.pose.pose(),      s.score,        s.reliability, s.ambiguity,
                          s.view.discrepancy, s.matchedShare, s.fault};
        std::vector<Place> &places = result_.places;
        const auto known = std::find_if(places.begin(), places.end(), [&](const Place &p) {
            return samePlace(Transformation2D(p.pose), s.pose);
        });
        if (known != places.end() && !isBetter(place, *known))
            return;
        if (known != places.end())
            places.erase(known);
        places.insert(std::upper_bound(places.begin(), places.end(), place, isBetter), place);
        if (places.size() > keptPlaces)
            places.pop_back();
    }
    Relocalized::Outcome judge() {
        std::vector<Place> &places = result_.places;
        const auto isGood = [this](const Place &p) { return p.fault == Fault::None && p.score >= minScore; };
        const bool anyIsGood = std::any_of(places.begin(), places.end(), isGood);
        for (const Place &place : places)
            result_.alike += place.score >= rivalShare * places.front().score;
        if (places.size() > maxPlaces)
            places.erase(places.begin() + std::ptrdiff_t(maxPlaces), places.end());
        if (anyIsGood && result_.alike > 1)
            return Relocalized::Outcome::Ambiguous;
        if (result_.searched < result_.parts)
            return Relocalized::Outcome::Unfinished;
        return anyIsGood && isGood(places.front()) ? Relocalized::Outcome::Found
                                                   : Relocalized::Outcome::Nowhere;
    }

    CorrespondenceFinder find_;
    SegmentMap map_;
    std::vector<Vector> parts_; // middles
    std::vector<LineSegment2D<double>> scan_;
    Relocalized result_;
};

} // namespace vectorlib
