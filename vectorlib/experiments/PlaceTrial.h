#pragma once

#include "gui/vector/ProgressParts.h"
#include "vectorlib/edges/EdgeExtractor.h"
#include "vectorlib/places/PlaceSearch.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace hermes::experiments {

using vector::ProgressParts;
using vector::ProgressSink;

/// A scan that was searched in a map, and what came of it.
struct PlaceTrial {
    std::size_t scan = 0;    ///< its number
    std::string set;         ///< which kind of scan in which kind of map; empty where there is one only
    bool isFirstHalf = true; ///< parameters are chosen on one half and judged on the other
    bool hasPlace = true;    ///< false: the scan is of another building
    vectorlib::Relocalized::Outcome outcome = vectorlib::Relocalized::Outcome::NoScan;
    double score = 0, probability = 0, reliability = 0; ///< of the first place
    std::vector<double> leads;                          ///< Place::lead of all places
    std::optional<std::size_t> right; ///< the first place within 0.5 m and 10 degrees of the true one
    double metres = 0, degrees = 0;   ///< of the first place from the true one
    double milliseconds = 0;          ///< processor time of the search

    bool isFound() const { return outcome == vectorlib::Relocalized::Outcome::Found; }
    bool isRight() const { return right == std::size_t(0); }
    bool isNear() const { return isRight() && metres <= 0.1 && degrees <= 2; }
};

/// Searches scans in maps, and keeps what came of it.
class PlaceTrials {
public:
    vectorlib::EdgeExtractor extract;
    std::vector<PlaceTrial> all;

    /// So many trials follow, whose progress is told.
    void expect(std::size_t trials, ProgressSink progress);
    /// The map of all scans until the next one; must live as long.
    void setMap(const std::vector<vectorlib::MapEdge> &slots);
    /// Searches a scan, sensor frame; `truth` is its pose in the map, nothing for one of another building.
    /// With `byEdges` its edges alone. Gives the trial that was added, to be named.
    PlaceTrial &add(vectorlib::PointSpan<float> points, const std::optional<vectorlib::Pose2D> &truth,
                    bool byEdges = false);

private:
    vectorlib::PlaceSearch search_;
    const std::vector<vectorlib::MapEdge> *slots_ = nullptr;
    std::size_t before_ = 0, expected_ = 0; // trials
    ProgressSink progress_;
};

/// Shares of all trials and processor times; what is right only where scans have a place.
nlohmann::ordered_json summaryOf(const std::vector<PlaceTrial> &trials);

} // namespace hermes::experiments
