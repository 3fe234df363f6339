#pragma once

#include "common/ros/Mapping.h"
#include "protocol/messages/Matching.h"
#include "protocol/messages/Motors.h"
#include "protocol/ros/Messages.h"

namespace hermes::ros {

/// A pose that the matcher trusts less is doubted.
constexpr double leastTrust = 0.5;

/// The odometry, of base_link in odom.
struct OdometryOf {
    bool operator()(const OdometryMessage &in, const Told &told, Odometry &out);
};

/// The pose of base_link in the map. How far it is to be trusted is told by its covariance: a direction that
/// the match leaves open has the deviation of 100 m, and what is doubted or lost gets a metre more.
struct MapPose {
    bool operator()(const PoseMessage &in, const Told &told, PoseWithCovarianceStamped &out);
};

/// How the wheels turn.
struct JointsOf {
    bool operator()(const WheelsMessage &in, const Told &told, JointState &out);
};

/// The frames that move: with each message of the odometry base_link in odom, and odom in the map as long as
/// the matcher tells it; without odometry base_link in the map with each pose; and the wheels.
class Transforms : public Translator {
public:
    bool take(const TopicUpdate &update, const Told &told, std::string &cdr, QString &problem) override;
    void lose(const QString &daemon) override;

private:
    void takeOdometry(const OdometryMessage &odometry, const Told &told);
    void takePose(const PoseMessage &pose, const Told &told);
    void takeWheels(const WheelsMessage &wheels, const Told &told);
    void add(const Header &parent, const std::string &child, const Transform &transform);

    std::optional<Pose2D> odometryInMap_;
    double poseAt_ = 0; ///< stamp of the last one
    QString poseFrom_;  ///< the daemon
    std::array<double, WheelsMessage::count> wheelAngles_{};
    double wheelsAt_ = 0; ///< stamp with which they were told last
    TfMessage out_;
};

/// Where the sensors are on the robot.
class FixedTransforms : public Translator {
public:
    bool take(const TopicUpdate &, const Told &, std::string &, QString &) override { return false; }
    bool refresh(const RobotModel &robot, double now, std::string &cdr) override;

private:
    int revision_ = -1;
};

} // namespace hermes::ros
