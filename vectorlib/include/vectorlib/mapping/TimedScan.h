#pragma once

#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/motion/OdometryTrack.h"

#include <algorithm>

namespace vectorlib {

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
