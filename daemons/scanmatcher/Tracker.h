#pragma once

#include "daemons/scanmatcher/OdometryModel.h"
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
    /// Forgets map, pose and counts.
    void clear();

    const vectorlib::MotionModel &motion() const { return model; }
    const TrackerCounts &counts() const { return total; }

private:
    /// Where the sensor is expected; tells the builder how sure that is.
    vectorlib::Pose2D expect(const Scan &scan);

    TrackerSettings configured;
    vectorlib::MotionModel model;
    OdometryModel odometry;
    TrackerCounts total;
};

} // namespace hermes
