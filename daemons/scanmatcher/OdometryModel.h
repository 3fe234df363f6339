#pragma once

#include "daemons/scanmatcher/Scan.h"

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

    /// Moves the scan's points to where they would have been seen from the sensor's place at this time after
    /// the scan's stamp; seconds.
    void straighten(Scan &scan, const OdometryTrack &track, float reference) const;

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
