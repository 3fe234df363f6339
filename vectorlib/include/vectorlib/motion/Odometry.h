#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace vectorlib {

/// Where the robot is at one time, by its odometry.
struct OdometrySample {
    double stamp = 0; ///< seconds since the Unix epoch
    Pose2D pose;      ///< of the robot in the odometry's frame
    Twist2D twist;    ///< robot frame
    /// Of the pose, since the odometry began; m^2, m rad, rad^2. Nothing where the odometry does not tell.
    std::optional<Eigen::Matrix3d> covariance;
};

/// The robot's way during one scan, by its odometry.
class OdometryTrack {
public:
    /// The samples are one or more, in order of time; either all have a covariance or none.
    OdometryTrack(std::uint64_t epoch, std::vector<OdometrySample> samples);

    /// Tracks of different epochs do not belong together: the odometry began anew between them.
    std::uint64_t epoch() const { return epoch_; }
    /// The robot in the odometry's frame, on an arc between two samples; beyond the last one as its twist
    /// says.
    Transformation2D at(double stamp) const;
    /// The covariance of the odometry at a time (seconds), between two samples in proportion; as
    /// OdometrySample::covariance.
    std::optional<Eigen::Matrix3d> covarianceAt(double stamp) const;

private:
    std::size_t knotBefore(double stamp) const;

    std::uint64_t epoch_;
    std::vector<OdometrySample> knots_; // the twist of each is that until the next one
};

/// The last samples of an odometry, from which each scan takes those of its time. Of fixed size; knows no
/// clock.
class OdometryBuffer {
public:
    static constexpr std::size_t capacity = 512;           ///< ten seconds at 50 Hz
    static constexpr double longestGap_s = 0.5;            ///< over a longer one nothing is interpolated
    static constexpr double longestForesight_s = 0.1;      ///< how far the last twist is trusted
    static constexpr double jump_m = 0.05, jump_rad = 0.1; ///< beyond what twice the speed explains

    /// What became of a sample.
    enum class Outcome {
        Taken,
        OutOfOrder, ///< not later than the one before; left out
        Restarted   ///< does not follow from those before (reset, gap, clock set): a new epoch begins with it
    };
    /// Takes the next sample.
    Outcome add(const OdometrySample &added);
    /// What comes next does not follow from what was.
    void restart();

    /// The way from begin to end (seconds since the Unix epoch), when it is known.
    std::optional<OdometryTrack> over(double begin, double end) const;

private:
    const OdometrySample &sample(std::size_t i) const {
        return ring_[(first_ + i) % capacity];
    } // 0 is the oldest
    static bool follows(const OdometrySample &before, const OdometrySample &after);

    std::array<OdometrySample, capacity> ring_;
    std::size_t first_ = 0, size_ = 0;
    std::uint64_t epoch_ = 0;
};

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
    std::optional<Transformation2D> frame() const {
        if (!last_)
            return std::nullopt;
        return last_->pose * mount_.inverse() * last_->robot.inverse();
    }

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

/// Watches whether the scans find the way that the odometry tells. Wheels that turn on the spot and scans
/// that are not the robot's make the two differ by more than any slip.
class OdometryCheck {
public:
    /// The robot's way in its own frame by each of them.
    struct Ways {
        Pose2D odometry, scans;
        double seconds = 0;

        /// By more than slip and noise explain.
        bool differ() const;
    };
    /// As soon as the odometry tells of so much way, it is compared; metres, radians.
    static constexpr double piece_m = 0.3, piece_rad = 0.3;
    /// By how much the ways may differ: a share of the odometry's, or that; metres, radians.
    static constexpr double share = 0.5, least_m = 0.15, least_rad = 0.15;

    /// The robot at one time (seconds) in the frame of the odometry, and in that of the map. True when this
    /// ends another piece that is contradicted, as the one before was.
    bool add(double stamp, const Pose2D &odometry, const Pose2D &scans);
    /// What comes next does not follow from what was.
    void restart() { *this = OdometryCheck(); }
    /// The last two pieces of the way, when the scans contradict both of them.
    const std::optional<Ways> &contradiction() const { return contradiction_; }

private:
    struct Point {
        double stamp;
        Pose2D odometry, scans;

        Ways to(const Point &end) const {
            return {odometry.inverse() * end.odometry, scans.inverse() * end.scans, end.stamp - stamp};
        }
    };
    std::optional<Point> begin_, before_; ///< of this piece, and of the one before when it was contradicted
    std::optional<Ways> contradiction_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/motion/Odometry.cpp")
