#pragma once

#include "vectorlib/io/CarmenLog.h"
#include "vectorlib/places/Relocalized.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <ostream>
#include <vector>

namespace hermes::vector {

/// A scan that was searched in a map, and how far the first place is from the reference.
struct PlaceResult {
    std::size_t scan = 0; ///< its number in the log
    vectorlib::Relocalized::Outcome outcome = vectorlib::Relocalized::Outcome::NoScan;
    std::size_t places = 0;
    double score = 0, probability = 0; ///< of the first place
    double metres = 0, degrees = 0;    ///< of the first place from the reference
    double milliseconds = 0;           ///< processor time of the search

    bool isFound() const { return outcome == vectorlib::Relocalized::Outcome::Found; }
    bool isWithin(double m, double deg) const { return places > 0 && metres <= m && degrees <= deg; }
    bool isRight() const { return isWithin(0.5, 10); }
};

/// What came of the scans of a log in a map.
struct PlacesReport {
    std::size_t mapSegments = 0;
    bool isSameBuilding = true; ///< else the scans have no place in the map, and no errors
    std::vector<PlaceResult> results;
};

/// Makes a map of every other scan of a log whose scan poses are a corrected reference, each expected at its
/// reference pose, and searches the scans between in it; or, with another log, all of its scans, which are
/// then to be refused.
PlacesReport placesExperiment(const vectorlib::CarmenLog &log, const vectorlib::CarmenLog *other,
                              const std::function<void(std::size_t done, std::size_t all)> &progress);

/// Shares of all scans, and processor times.
nlohmann::ordered_json summaryOf(const PlacesReport &report);
/// A row a scan; of scans of another building only whether their first place was accepted, and what speaks
/// for it.
void writeCsv(std::ostream &out, const PlacesReport &report);

} // namespace hermes::vector
