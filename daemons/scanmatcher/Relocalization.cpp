#include "daemons/scanmatcher/Relocalization.h"

#include <cmath>

namespace hermes {

using vectorlib::Fault;
using vectorlib::Transformation2D;

namespace {

constexpr double overlap = 0.1; // of neighbouring parts, so that no place falls between them; metres

// Nearer places are one, found from two parts or from other pairs.
constexpr vectorlib::SamePose samePlace{0.3, 0.1};

constexpr std::size_t maxParts = 1000000; // a map of 2.8 km x 2.8 km; what is beyond stays unsearched
constexpr std::size_t keptPlaces = 64;

bool isBetter(const Place &a, const Place &b) {
    return a.score > b.score;
}

} // namespace

std::string Relocalized::text() const {
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
                                    vectorlib::describe(places.front().fault);
    case Outcome::Ambiguous:
        return count(alike) + " places in the map fit alike";
    case Outcome::Unfinished:
        return "only " + count(searched) + " of " + count(parts) + " parts of the map were searched";
    }
    return {};
}

const Relocalized &Relocalization::operator()(const vectorlib::VectorMap &map,
                                              const std::vector<vectorlib::EdgeRaw2D> &edges,
                                              const vectorlib::Pose2D &lastKnown) {
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

void Relocalization::takeMap(const vectorlib::VectorMap &map, Vector lastKnown) {
    map_ = vectorlib::SegmentMap();
    parts_.clear();
    Vector low(INFINITY, INFINITY), high = low * -1.0;
    map.forEach([&](const vectorlib::MapEdge &edge) {
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

void Relocalization::takeScan(const std::vector<vectorlib::EdgeRaw2D> &edges) {
    scan_.clear();
    for (const vectorlib::EdgeRaw2D &edge : edges)
        scan_.push_back(edge.segment);
    std::stable_sort(scan_.begin(), scan_.end(),
                     [](const auto &a, const auto &b) { return a.length() > b.length(); });
    if (scan_.size() > maxEdges)
        scan_.erase(scan_.begin() + std::ptrdiff_t(maxEdges), scan_.end());
}

void Relocalization::search(Clock::time_point end) {
    find_.settings.permitted = {part, part, vectorlib::pi};
    find_.settings.discrepancyShare = discrepancyShare;
    for (const Vector middle : parts_) {
        if (Clock::now() >= end)
            break;
        const vectorlib::SearchResult &found = find_(map_, scan_, Transformation2D(middle.x, middle.y, 0));
        for (const vectorlib::Solution &solution : found.solutions)
            take(solution);
        if (found.outcome != vectorlib::SearchOutcome::TooManyPairs)
            ++result_.searched;
    }
}

// Keeps the places best first.
void Relocalization::take(const vectorlib::Solution &s) {
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

Relocalized::Outcome Relocalization::judge() {
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
    return anyIsGood && isGood(places.front()) ? Relocalized::Outcome::Found : Relocalized::Outcome::Nowhere;
}

} // namespace hermes
