#pragma once

#include "gui/vector/LidarCapture.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/segmentation/EarSegmenter.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace hermes {

/// One scan on its way into a map.
struct MapScan {
    std::vector<vectorlib::Vector2D<float>> points; ///< sensor frame, counter-clockwise; metres
    std::vector<float> seconds; ///< when each point was measured, after stamp; empty: at once
    double stamp = 0;           ///< seconds
    /// Motion since the scan delivered before, by odometry; nothing when there is none.
    std::optional<vectorlib::Transformation2D> motion;
    std::optional<vectorlib::Pose2D> reference; ///< the true pose as far as it is known
    bool closed = true;                         ///< a full turn
    double fieldOfView = 2 * vectorlib::pi;     ///< radians
    std::size_t rays = 0;                       ///< with and without return; 0 when not known
    bool partial = false;                       ///< too little of a turn to be used
};

/// What is read and how.
struct MapSourceOptions {
    std::string path;
    std::size_t every = 1;    ///< every N-th scan only
    bool corrected = false;   ///< a CARMEN log's scan poses are a reference, not odometry
    bool skipDamaged = false; ///< count damaged lines of a CARMEN log instead of failing
    bool open = false;        ///< scans of a folder are less than a full turn
    SensorOptions sensor;     ///< of a capture
};

/// What was met beside the scans.
struct MapSourceReport {
    std::size_t damagedLines = 0;
    std::string firstDamage;
    std::string otherSensors; ///< a message about those in a capture that were not read, or nothing
};

/// Takes a scan, how many were delivered before it and how many there are in all (0 when not known).
using MapScanSink = std::function<void(const MapScan &, std::size_t number, std::size_t total)>;

/// Delivers the scans of a CARMEN log, a capture of an HDL-32E or VLP-16 (its horizontal ring, a turn a scan)
/// or a folder of points files in the order of their names. Throws Failure on damaged input, after delivering
/// what came before it.
MapSourceReport readMapScans(const MapSourceOptions &options, const MapScanSink &sink);

} // namespace hermes
