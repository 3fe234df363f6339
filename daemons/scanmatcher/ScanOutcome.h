#pragma once

#include "daemons/scanmatcher/MapMirror.h"
#include "daemons/scanmatcher/MatcherMessages.h"
#include "protocol/messages/Matching.h"
#include "vectorlib/mapping/ScanTracker.h"

#include <optional>

namespace hermes::scanmatcher {

/// What a scan gave.
struct ScanOutcome {
    ScanResult result;
    MapChanges changes;
    vectorlib::ScanTrackerCounts counts;
    vectorlib::ScanReport::Outcome outcome = vectorlib::ScanReport::Outcome::Skipped;
    std::size_t points = 0; ///< of the scan
    std::optional<vectorlib::OdometryCheck::Ways> contradiction;
    vectorlib::ScannerCheck scanner;
    vectorlib::SecondScanner::State second = vectorlib::SecondScanner::State::OnTrial;
    std::optional<vectorlib::Pose2D> secondFitting; ///< where it seems to be on the robot
    bool replayed = false;
    std::optional<vectorlib::Relocalized> recovery; ///< when the whole map was searched after this scan
};

/// That of the scan that the tracker took last; the changes of its map count as told then.
ScanOutcome outcomeOf(vectorlib::ScanTracker &tracker, const Scan &scan);

} // namespace hermes::scanmatcher
