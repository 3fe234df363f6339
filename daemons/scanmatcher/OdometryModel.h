#pragma once

#include "daemons/scanmatcher/OdometryTrack.h"

#include <optional>

namespace hermes {

/// Where a sensor is expected next by the odometry of the robot that carries it: at its last pose, moved by
/// the way since.
class OdometryModel {
public:
    /// Errors of an expected pose that the odometry's covariance does not know: of the last pose itself, of
    /// the stamps. Standard deviations; metres, radians.
    static constexpr double leastDeviationXY = 0.01, leastDeviationAlpha = 0.005;

    struct Expectation {
        vectorlib::Pose2D pose;
        double deviationXY = 0, deviationAlpha = 0; ///< metres, radians
    };

    /// The sensor's pose in the robot's frame.
    void setMount(const vectorlib::Pose2D &sensor);
    void reset() { last_.reset(); }
    void update(const vectorlib::Pose2D &pose, const OdometryTrack &track, double stamp);
    /// Nothing when the track does not follow from that of the last update.
    std::optional<Expectation> expect(const OdometryTrack &track, double stamp) const;

    /// The sensor's mean velocity from begin to end. In a turn of 0.1 s a robot that brakes with 4 m/s^2 is
    /// never more than 5 mm from where this leads; the stamps of single samples are often worse.
    vectorlib::Twist2D twist(const OdometryTrack &track, double begin, double end) const;

private:
    struct Last {
        quint64 epoch;
        vectorlib::Transformation2D pose;  // sensor, map frame
        vectorlib::Transformation2D robot; // odometry frame
        Eigen::Matrix3d covariance;        // of `robot`
    };
    vectorlib::Transformation2D ofSensor(const vectorlib::Transformation2D &robotMotion) const;

    vectorlib::Transformation2D mount_;
    std::optional<Last> last_;
};

} // namespace hermes
