#pragma once

#include "daemons/recorder/SessionReader.h"
#include "protocol/messages/Motion.h"

#include <deque>

namespace hermes::recorder {

/// Makes lines of a CARMEN log of odometry and the scans of the scanner that the matcher took, or else of the
/// first one: metres, radians, seconds.
class CarmenText {
public:
    static QStringList topics();

    /// The line of a message; empty: it gives none, as a scan before there is odometry.
    QByteArray take(const SessionMessage &message);
    quint64 scans() const { return scans_; }

private:
    QByteArray takeOdometry(const SessionMessage &message);
    QByteArray takeScan(const SessionMessage &message);
    /// Whether the scans of this topic are those.
    bool isMapped(const SessionMessage &message);
    std::optional<Pose2D> robotAt(double stamp) const;

    struct Sample {
        double stamp = 0;
        Pose2D pose;
        Twist2D twist;
    };
    std::deque<Sample> samples_; ///< the last ones
    Pose2D mount_;               ///< of the sensor on the robot
    bool isUpsideDown_ = false;
    QString source_, topic_; ///< its address, as the matcher had it; its topic
    quint64 scans_ = 0;
};

} // namespace hermes::recorder
