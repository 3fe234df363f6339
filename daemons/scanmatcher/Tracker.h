#pragma once

#include "daemons/scanmatcher/OdometryModel.h"
#include "daemons/scanmatcher/Relocalization.h"
#include "daemons/scanmatcher/Scan.h"
#include "vectorlib/mapping/MapBuilder.h"
#include "vectorlib/mapping/MotionModel.h"

#include <chrono>
#include <optional>

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
    qint64 relocalizeAfter = 10;     ///< lost scans in a row; 0: never by itself
    double relocalizeSeconds = 3;    ///< longest search
    vectorlib::Pose2D sensorOnRobot; ///< the odometry is that of the robot
};

/// Counts of all scans since the start or the last clear.
struct TrackerCounts {
    quint64 scans = 0, matched = 0, lost = 0, skipped = 0;
    quint64 byOdometry = 0; ///< scans whose expected pose came from the odometry
    double totalMs = 0;     ///< of all scans together
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

    /// Compensates the motion during the scan, predicts, matches, maps: by the scan's odometry where it is
    /// known, else by the motion so far. The scan's stamp becomes the middle of its time, to which the pose
    /// refers.
    const vectorlib::ScanReport &process(Scan &scan);
    /// Puts the sensor somewhere, standing still.
    void place(const vectorlib::Pose2D &pose);
    /// Finds the last scan in the whole map; puts the sensor there when it was found and `apply`.
    Relocalized relocalize(bool apply);
    /// The same by itself, to be called after each scan: when enough scans in a row were lost, and for at
    /// most about a tenth of the time; else nothing.
    std::optional<Relocalized> recover();
    /// Forgets map, pose and counts.
    void clear();

    const vectorlib::MotionModel &motion() const { return model; }
    const TrackerCounts &counts() const { return total; }

private:
    /// Where the sensor is expected; tells the builder how sure that is.
    vectorlib::Pose2D expect(const Scan &scan);
    bool isSearchDue() const;

    TrackerSettings configured;
    vectorlib::MotionModel model;
    OdometryModel odometry;
    TrackerCounts total;
    Relocalization search;
    int lostInARow = 0;
    std::chrono::steady_clock::time_point nextSearch;
};

} // namespace hermes
