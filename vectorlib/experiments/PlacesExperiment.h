#pragma once

#include "gui/vector/ProgressParts.h"
#include "vectorlib/experiments/PlaceTrial.h"
#include "vectorlib/io/CarmenLog.h"

#include <ostream>
#include <vector>

namespace hermes::experiments {

using vector::ProgressParts;
using vector::ProgressSink;

/// What came of the scans of a log in a map.
struct PlacesReport {
    std::size_t mapSegments = 0;
    bool isSameBuilding = true; ///< else the scans have no place in the map, and no errors
    std::vector<PlaceTrial> trials;
};

/// As EarSettings::forScanner.
vectorlib::EarSettings scannerOf(const vectorlib::CarmenScan &scan);
/// The map of every other scan of a log whose scan poses are a corrected reference, each expected at its
/// reference pose.
std::vector<vectorlib::MapEdge> mapOfHalf(const vectorlib::CarmenLog &log, const ProgressSink &progress = {});

/// Makes such a map, and searches the scans between in it; or, with another log, all of its scans, which are
/// then to be refused.
PlacesReport placesExperiment(const vectorlib::CarmenLog &log, const vectorlib::CarmenLog *other,
                              const ProgressSink &progress);

/// Shares of all scans, and processor times.
nlohmann::ordered_json summaryOf(const PlacesReport &report);
/// A row a scan; of scans of another building only whether their first place was accepted, and what speaks
/// for it.
void writeCsv(std::ostream &out, const PlacesReport &report);

} // namespace hermes::experiments
