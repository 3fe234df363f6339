#pragma once

#include "vectorlib/correspondence/CorrespondenceFinder.h"
#include "vectorlib/mapping/VectorMap.h"

#include <chrono>
#include <string>
#include <vector>

namespace hermes {

/// A place in the map where a scan fits, and what speaks for it.
struct Place {
    vectorlib::Pose2D pose; ///< of the sensor in the map's frame
    double score = 0;       ///< in [0, 1]; places are ranked by it
    double reliability = 0; ///< in [0, 1]
    double ambiguity = 0;   ///< m^2
    double discrepancy = 0; ///< of what would be seen from there and what was seen; m^2
    double matchedShare = 0;
    vectorlib::Fault fault = vectorlib::Fault::None; ///< None when the place is accepted
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
    std::string text() const;
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
    const Relocalized &operator()(const vectorlib::VectorMap &map,
                                  const std::vector<vectorlib::EdgeRaw2D> &edges,
                                  const vectorlib::Pose2D &lastKnown);

private:
    using Clock = std::chrono::steady_clock;
    using Vector = vectorlib::Vector2D<double>;

    void takeMap(const vectorlib::VectorMap &map, Vector lastKnown);
    void takeScan(const std::vector<vectorlib::EdgeRaw2D> &edges);
    void search(Clock::time_point end);
    void take(const vectorlib::Solution &solution);
    Relocalized::Outcome judge();

    vectorlib::CorrespondenceFinder find_;
    vectorlib::SegmentMap map_;
    std::vector<Vector> parts_; // middles
    std::vector<vectorlib::LineSegment2D<double>> scan_;
    Relocalized result_;
};

} // namespace hermes
