#pragma once

#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/motion/MotionModel.h"
#include "vectorlib/motion/Odometry.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
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
    /// How many of each scan's edges, the first ones, were seen from its pose; null: all.
    const std::vector<std::uint32_t> *own = nullptr;
};

/// The first and the last of the points' times; 0 without any.
inline double firstTime(const std::vector<float> &seconds) {
    return seconds.empty() ? 0 : double(*std::min_element(seconds.begin(), seconds.end()));
}
inline double lastTime(const std::vector<float> &seconds) {
    return seconds.empty() ? 0 : double(*std::max_element(seconds.begin(), seconds.end()));
}

/// What another scanner on the robot saw at about the time of a scan.
struct SecondScan {
    std::vector<Vector2D<float>> points; ///< in the frame of that scanner, counter-clockwise; metres
    std::vector<float> seconds;          ///< when each point was measured, after stamp; empty: at once
    double stamp = 0;                    ///< by the clock of the scan's stamp; seconds
    std::size_t rays = 0;                ///< as of TimedScan

    double begin() const { return stamp + firstTime(seconds); }
    double end() const { return stamp + lastTime(seconds); }
};

/// One scan on its way into a map, as a scanner that turns or sweeps took it.
struct TimedScan {
    std::vector<Vector2D<float>> points;   ///< sensor frame, counter-clockwise; metres
    std::vector<float> seconds;            ///< when each point was measured, after stamp; empty: at once
    double stamp = 0;                      ///< seconds since the Unix epoch, or of the log's clock
    std::size_t rays = 0;                  ///< with and without a return; 0 when not known
    double fieldOfView = 2 * pi;           ///< radians
    bool closed = true;                    ///< a full turn
    std::optional<OdometryTrack> odometry; ///< of the robot during the scans, when it is known
    std::optional<SecondScan> second;      ///< of about the same time; alone where there are no points

    /// When the first and the last point were measured.
    double begin() const { return stamp + firstTime(seconds); }
    double end() const { return stamp + lastTime(seconds); }
    double middle() const { return 0.5 * (begin() + end()); }

    /// Of a scanner that hangs upside down.
    void turnOver() {
        for (Vector2D<float> &point : points)
            point.y = -point.y;
    }
    /// Between two scans that go together; seconds.
    static constexpr double longestApart_s = 0.25;
    /// Takes a scan of the second scanner, unless it is of another time. Gives how much older it is; seconds.
    double addSecond(TimedScan &&other) {
        const double apart = middle() - other.middle();
        if (std::abs(apart) <= longestApart_s)
            second = {std::move(other.points), std::move(other.seconds), other.stamp, other.rays};
        return apart;
    }
    /// When the first and the last point were seen, where there is a second scan by that, too.
    double firstSeen() const { return second ? std::min(begin(), second->begin()) : begin(); }
    double lastSeen() const { return second ? std::max(end(), second->end()) : end(); }
};

} // namespace vectorlib
