#pragma once

#include "daemons/scanmatcher/Scan.h"
#include "vectorlib/mapping/MapBuilder.h"
#include "vectorlib/mapping/MotionModel.h"

namespace hermes {

/// What the tracker can be told, from the daemon's settings.
struct TrackerSettings {
    bool compensateMotion = true;
    double sigma = 0.02;                  ///< of points from their line; metres
    double expectedDeviationXY = 0.05;    ///< metres
    double expectedDeviationAlpha = 0.10; ///< radians
    double permittedXY = 0.5;             ///< metres
    double permittedAlpha = 0.4;          ///< radians
    double minMatchedShare = 0.15;
};

/// Counts of all scans since the start or the last clear.
struct TrackerCounts {
    quint64 scans = 0, matched = 0, lost = 0, skipped = 0;
    double totalMs = 0; ///< of all scans together
};

/// Follows the sensor through its map and lets the map grow, scan by scan. Plain computing: no thread, no
/// event loop.
class Tracker {
public:
    enum class Mode {
        Mapping,     ///< the map grows
        Localization ///< the map stays as it is
    };

    vectorlib::MapBuilder builder;

    void apply(const TrackerSettings &settings);
    void setMode(Mode mode) { builder.settings.grow = mode == Mode::Mapping; }

    /// Compensates the motion during the scan, predicts, matches, maps. The scan's stamp becomes the middle
    /// of its time, to which the pose refers.
    const vectorlib::ScanReport &process(Scan &scan);
    /// Puts the sensor somewhere, standing still.
    void place(const vectorlib::Pose2D &pose);
    /// Forgets map, pose and counts.
    void clear();

    const vectorlib::MotionModel &motion() const { return model; }
    const TrackerCounts &counts() const { return total; }

private:
    TrackerSettings configured;
    vectorlib::MotionModel model;
    TrackerCounts total;
};

} // namespace hermes
