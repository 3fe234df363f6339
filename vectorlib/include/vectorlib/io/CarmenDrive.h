#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/io/CarmenLog.h"
#include "vectorlib/motion/Odometry.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace vectorlib {

/// The way of the robot through a log, scan by scan, as its odometry tells it and as far as it can be
/// believed.
class CarmenDrive {
public:
    /// A motion is a leap when it is longer than leap_m and the way at fastest_mps, or turns by more than
    /// leap_rad and what is turned at fastest_radps; metres, radians, seconds.
    static constexpr double leap_m = 1, fastest_mps = 5, leap_rad = 0.8, fastest_radps = 3;
    static constexpr double longestPause_s = 5; ///< no more of the time counts
    static constexpr std::size_t repeated = 16; ///< a scan is compared with so many before it

    /// The log must outlive this. mount: the sensor on the robot.
    CarmenDrive(const CarmenLog &log, CarmenOdometryKind kind, const Pose2D &mount = {})
        : log_(log)
        , kind_(kind)
        , mount_(mount) {}

    /// Goes on to the next scan; there must be one.
    void advance();
    /// Whether the last scan has the stamp and the ranges of one shortly before it.
    bool isRepeated() const { return isRepeated_; }
    /// Where the odometry puts the sensor at the last scan, and how fast it moves from the scan before to the
    /// next one; nothing where the log does not tell.
    std::optional<OdometryTrack> odometry() const;

    /// Repeated scans so far.
    std::size_t repetitions() const { return repeated_; }
    /// Leaps so far.
    std::size_t leaps() const { return leaps_; }

private:
    // The robot at a scan, by odometry since its last gap.
    struct Step {
        Transformation2D robot;
        std::uint64_t epoch = 0;
        std::size_t known = 0; // the last scan up to here with odometry
        bool isKnown = true;
    };

    static bool isSame(const CarmenScan &a, const CarmenScan &b) {
        return a.stamp == b.stamp && a.ranges == b.ranges;
    }
    Step stepTo(std::size_t i);
    Twist2D twist() const;
    // The clock of a log may stand, or be set back: then it was any pause.
    static bool leaps(const Transformation2D &motion, double seconds);

    const CarmenLog &log_;
    CarmenOdometryKind kind_;
    Pose2D mount_;
    std::vector<Step> steps_;
    std::size_t repeated_ = 0, leaps_ = 0;
    bool isRepeated_ = false;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/CarmenDrive.cpp")
