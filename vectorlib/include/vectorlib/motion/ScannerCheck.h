#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"

#include <Eigen/Core>

#include <optional>

namespace vectorlib {

/// Learns from the motions of a drive, each told by the odometry and by the scans alone, whether the scanner
/// is what it is said to be. Of fixed size; constant time, allocates nothing.
class ScannerCheck {
public:
    /// The sensor's motion from one scan to the next that came `seconds` later, by each of them. The walls
    /// must fix that of the scans in all directions.
    void add(const Transformation2D &odometry, const Transformation2D &scans, double seconds);

    /// The scans turn the other way than the odometry: their angles count clockwise, or the scanner hangs
    /// upside down.
    bool isMirrored() const { return against_rad_ > enough_rad && against_rad_ > mostly * with_rad_; }
    /// The angle by which the sensor is turned on the robot, beyond what is known of its mount; radians,
    /// counter-clockwise. Nothing where it is small, or the drive does not tell.
    std::optional<double> turned() const;
    /// How long the scanner takes for a full turn when its points are taken for those of one moment; seconds,
    /// below 0 when it turns clockwise. A sensor that turns by w (rad/s) then seems to turn by w T / 2 pi
    /// less, to whichever side. Nothing where the drive does not tell it from errors of the odometry.
    std::optional<double> secondsPerTurn() const;

private:
    static constexpr double least_rad = 0.01, least_m = 0.02; // of a motion
    static constexpr double enough_rad = 0.5, enough_m = 1, mostly = 4;
    static constexpr double alike_rad = 0.5; // of a turn
    static constexpr double straight_rad_per_m = 1;
    static constexpr double leastTurned = 0.15, alike = 0.9;
    static constexpr double wild = 0.2, wild_rad = 0.02; // beyond both the two motions have nothing in common
    static constexpr int enoughTurns = 20;
    static constexpr double sure = 4; // standard errors

    double with_rad_ = 0, against_rad_ = 0;
    double way_m_ = 0, lengths_ = 0; // of straight motions
    Vector2D<double> directions_;    // sum of the scans' ways as the odometry's see them
    // Normal equations of what the scans turn more: in proportion to the turn, to the way, to the turn's size
    // (slip), and to turn times rate.
    Eigen::Matrix4d h_ = Eigen::Matrix4d::Zero();
    Eigen::Vector4d g_ = Eigen::Vector4d::Zero();
    double squares_ = 0;
    int turns_ = 0;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/motion/ScannerCheck.cpp")
