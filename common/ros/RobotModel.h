#pragma once

#include "protocol/messages/Motion.h"
#include "protocol/ros/Common.h"

#include <QJsonObject>
#include <QString>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hermes::ros {

/// Where a sensor is on the robot.
struct Mount {
    Pose2D pose;
    bool isUpsideDown = false;
};

/// A wheel: its place in the robot's frame, and the heading of its axis turned by 90 degrees.
struct WheelPlace {
    std::string name; ///< "front_left"
    Pose2D pose;
    double radius = 0; ///< m
};

/// What is known of the robot from the settings of its daemons, and how its frames are called.
class RobotModel {
public:
    /// prefix: of all frames, for several robots.
    explicit RobotModel(const QString &prefix)
        : prefix_(prefix.toStdString()) {}

    std::string frame(const std::string &name) const { return prefix_ + name; }
    std::string mapFrame() const { return frame("map"); }
    std::string odometryFrame() const { return frame("odom"); }
    std::string baseFrame() const { return frame("base_link"); }
    /// Of a scanner: the daemon's name.
    std::string sensorFrame(const QString &daemon) const { return frame(daemon.toStdString()); }

    /// A daemon that publishes scans, at this address.
    void addScanner(const QString &daemon, const QString &address);
    /// The settings of the scan matcher and of the motor control; those of others say nothing here.
    void takeSettings(const QString &daemon, const QJsonObject &settings);

    /// Of each scanner; those that the matcher does not name are taken for being in the robot's centre.
    std::map<QString, Mount> mounts() const;
    /// Of the scanner that the matcher matches, whose poses it tells; none: not known.
    std::optional<Mount> matchedMount() const;
    /// Whether it is that scanner; nothing: the matcher has not told yet.
    std::optional<bool> isMatched(const QString &scanner) const;
    const std::vector<WheelPlace> &wheels() const { return wheels_; }
    double halfLength() const { return halfLength_; } ///< of the body, m
    double halfWidth() const { return halfWidth_; }
    /// Counts what has changed.
    int revision() const { return revision_; }

private:
    void takeWheels(const QJsonObject &frame);

    const std::string prefix_;
    std::map<QString, int> scanners_; ///< and their ports
    struct Matched {
        int port = 0;
        Mount mount;
    };
    std::vector<Matched> matched_; ///< by the matcher; the first one gives the poses
    std::vector<WheelPlace> wheels_;
    double halfLength_ = 0.35, halfWidth_ = 0.25;
    int revision_ = 0;
};

Time toTime(double stamp);
Header headerOf(double stamp, const std::string &frame);
/// In the plane, at this heading.
Quaternion toQuaternion(double theta);
Quaternion toQuaternion(const Mount &mount);
Pose toPose(const Pose2D &pose);
Transform toTransform(const Pose2D &pose);

} // namespace hermes::ros
