#pragma once

#include "vectorlib/mapping/ScanTracker.h"

namespace vectorlib {

/// The settings of a tracker by the names that hermes-scanmatcher gives them: a live drive and a recorded one
/// are mapped alike. number: gives the value of a name, a truth as 0 or 1.
template <typename Number>
ScanTrackerSettings namedTrackerSettings(const Number &number) {
    ScanTrackerSettings s;
    s.compensateMotion = number("matcher.compensate_motion") != 0;
    s.tracking.expectedDeviationXY = number("matcher.expected_deviation_m");
    s.tracking.expectedDeviationAlpha = number("matcher.expected_deviation_rad");
    s.tracking.permitted = {number("matcher.permitted_m"), number("matcher.permitted_m"),
                            number("matcher.permitted_rad")};
    s.tracking.minMatchedShare = number("matcher.min_matched_share");
    s.relocalizeAfter = std::int64_t(number("matcher.relocalize_after"));
    s.relocalizeSeconds = number("matcher.relocalize_s");
    s.sensorOnRobot = {number("sensor.x_m"), number("sensor.y_m"), number("sensor.theta_rad")};
    s.secondOnRobot = {number("sensor2.x_m"), number("sensor2.y_m"), number("sensor2.theta_rad")};
    return s;
}

} // namespace vectorlib
