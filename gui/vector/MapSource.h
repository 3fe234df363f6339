#pragma once

#include "gui/vector/BagDrive.h"
#include "gui/vector/LidarCapture.h"
#include "gui/vector/RecordedSession.h"
#include "vectorlib/io/CarmenLog.h"
#include "vectorlib/mapping/TimedScan.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace hermes::vector {

/// One scan on its way into a map.
struct MapScan : vectorlib::TimedScan {
    std::optional<vectorlib::Pose2D> reference; ///< the true pose as far as it is known
    enum class Fault {
        None,
        Partial,  ///< too little of a turn
        Repeated, ///< the stamp and the ranges of a scan shortly before
        Empty     ///< no ray had a return
    };
    Fault fault = Fault::None; ///< why it is not to be used
};

/// What is read and how.
struct MapSourceOptions {
    std::string path;
    /// That path leads to; null: it is none. For one reading.
    std::shared_ptr<RecordedSession> session;
    std::shared_ptr<BagDrive> bag; ///< the same of a bag whose scanner is chosen
    BagOptions scanner;            ///< of a bag
    std::size_t every = 1;         ///< every N-th scan only
    bool corrected = false;        ///< a CARMEN log's scan poses are a reference, not odometry
    bool skipDamaged = false;      ///< count damaged lines of a CARMEN log instead of failing
    bool open = false;             ///< scans of a folder are less than a full turn
    /// Of a CARMEN log, instead of what it tells: the sensor's pose on the robot; degrees, metres.
    std::optional<vectorlib::Pose2D> mount; ///< also of a session or a bag
    std::optional<double> fieldOfView, maxRange;
    /// Of its scanner, below 0 when it turns clockwise; 0: a scan is of one moment. Nothing: the drive tells.
    std::optional<double> secondsPerTurn;
    bool mirrored = false; ///< its angles count clockwise
    SensorOptions sensor;  ///< of a capture
};

/// What was met beside the scans.
struct MapSourceReport {
    std::size_t damagedLines = 0;
    std::string firstDamage;
    std::string otherSensors; ///< a message about what of a capture, a session or a bag was read and what not
    std::size_t repeated = 0, empty = 0;                ///< scans
    std::size_t stampsBack = 0;                         ///< scans with a stamp before the last one's
    std::size_t odometryRefused = 0, odometryLeaps = 0; ///< poses, and motions between scans
    std::optional<vectorlib::RepeatedRange> noReturn;   ///< as of CarmenLog
    std::size_t assumedRays = 0;                        ///< as of CarmenLog
    vectorlib::Pose2D mount;                            ///< of the sensor on the robot, by a log or an option
    double secondsPerTurn = 0; ///< of the scanner of a log; 0: its points are of one moment
    bool isTurnTold = false;   ///< by an option

    /// For the summary: what there was none of is left out.
    nlohmann::ordered_json summary() const;
    /// The same for people, a line each.
    void warn(std::ostream &out) const;
};

/// Takes a scan, which it may alter, how many were delivered before it and how many there are in all (0 when
/// not known).
using MapScanSink = std::function<void(MapScan &, std::size_t number, std::size_t total)>;

/// Delivers the scans of a CARMEN log, a capture of an HDL-32E or VLP-16 (its horizontal ring, a turn a scan)
/// a session or a bag with its odometry, or a folder of points files in the order of their names, numbers by
/// their size. Throws Failure on damaged input, after delivering what came before it.
MapSourceReport readMapScans(const MapSourceOptions &options, const MapScanSink &sink);

} // namespace hermes::vector
