#pragma once

#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/motion/Odometry.h"

#include <algorithm>
#include <vector>

namespace vectorlib {

/// What tells how a scan lies to the one before.
enum class TrackedBy {
    Map,  ///< it was found in the map where it was well expected
    Scan, ///< a scan before it, as the map did not show it or had lost the one before; a guess where neither
          ///< does
    Odometry, ///< that alone: it was lost
    Nothing,  ///< a guess, or found in the map where it was guessed
    Placed    ///< the sensor was put there, by a person or a search: the way between is not known
};

/// What a whole drive saw: the edges of each scan (sensor frame) and the pose of each (map frame). As many
/// poses as scans; a scan in doubt has no edges. Owns neither.
struct ScanDrive {
    const std::vector<std::vector<EdgeRaw2D>> &edges;
    const std::vector<Pose2D> &poses;
};

/// One scan on its way into a map, as a scanner that turns or sweeps took it.
struct TimedScan {
    std::vector<Vector2D<float>> points;   ///< sensor frame, counter-clockwise; metres
    std::vector<float> seconds;            ///< when each point was measured, after stamp; empty: at once
    double stamp = 0;                      ///< seconds since the Unix epoch, or of the log's clock
    std::size_t rays = 0;                  ///< with and without a return; 0 when not known
    double fieldOfView = 2 * pi;           ///< radians
    bool closed = true;                    ///< a full turn
    std::optional<OdometryTrack> odometry; ///< of the robot during the scan, when it is known

    /// When the first and the last point were measured.
    double begin() const {
        return stamp + (seconds.empty() ? 0 : double(*std::min_element(seconds.begin(), seconds.end())));
    }
    double end() const {
        return stamp + (seconds.empty() ? 0 : double(*std::max_element(seconds.begin(), seconds.end())));
    }
};

} // namespace vectorlib
