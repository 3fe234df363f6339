#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Twist2D.h"
#include "vectorlib/motion/OdometryTrack.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace vectorlib {

/// Where a sensor is expected next by the odometry of the robot that carries it: at its last pose, moved by
/// the way since.
class OdometryModel {
public:
    /// Errors of an expected pose that the odometry's covariance does not know: of the last pose itself, of
    /// the stamps. Standard deviations; metres, radians.
    static constexpr double leastDeviationXY = 0.01, leastDeviationAlpha = 0.005;

    /// Standard deviations; metres, radians.
    struct Deviations {
        double xy = 0, alpha = 0;
    };
    /// An expected pose of the sensor in the map's frame, and how far it may be wrong.
    struct Expectation {
        Pose2D pose;
        std::optional<Deviations> deviations; ///< nothing where the odometry tells no covariance
    };

    /// The sensor's pose in the robot's frame.
    void setMount(const Pose2D &sensor) { mount_ = Transformation2D(sensor); }
    /// Forgets the last pose: nothing is expected before the next update.
    void reset() { last_.reset(); }
    /// The sensor was at `pose` (map frame) at the time `stamp` (seconds), which the track tells of.
    void update(const Pose2D &pose, const OdometryTrack &track, double stamp) {
        last_ = Last{track.epoch(), Transformation2D(pose), track.at(stamp), track.covarianceAt(stamp)};
    }
    /// Nothing when the track does not follow from that of the last update.
    std::optional<Expectation> expect(const OdometryTrack &track, double stamp) const;

    /// The last pose lies elsewhere: the map was corrected.
    void move(const Transformation2D &moved);
    /// The frame of the odometry in that of the map, as of the last update.
    std::optional<Transformation2D> frame() const;

    /// The sensor's mean velocity from begin to end. In a turn of 0.1 s a robot that brakes with 4 m/s^2 is
    /// never more than 5 mm from where this leads; the stamps of single samples are often worse.
    Twist2D twist(const OdometryTrack &track, double begin, double end) const;

private:
    struct Last {
        std::uint64_t epoch;
        Transformation2D pose;                     // sensor, map frame
        Transformation2D robot;                    // odometry frame
        std::optional<Eigen::Matrix3d> covariance; // of `robot`
    };
    Transformation2D ofSensor(const Transformation2D &robotMotion) const {
        return mount_.inverse() * robotMotion * mount_;
    }
    // What the uncertainty grew by on the way from one pose to another, of which both hold the sum since the
    // start: Q = P2 - F P1 F', where F tells what a wrong heading at the first pose does to the second.
    static Eigen::Matrix3d growth(const Transformation2D &from, const Eigen::Matrix3d &before,
                                  const Transformation2D &to, const Eigen::Matrix3d &after);
    static double deviation(double least, double variance) {
        return std::sqrt(least * least + std::max(0.0, variance)); // rounding may make a zero negative
    }

    Transformation2D mount_;
    std::optional<Last> last_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/motion/OdometryModel.cpp")
