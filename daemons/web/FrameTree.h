#pragma once

#include "common/ros/RobotModel.h"
#include "protocol/messages/Matching.h"

#include <QJsonObject>

namespace hermes::web {

/// `sec` and `nsec` of seconds since the epoch.
QJsonObject timeJson(double stamp);
/// `position` and `orientation` of a pose in the plane.
QJsonObject poseJson(const Pose2D &pose);

/// How the frames of the robot lie in each other: map > odom > base_link > scanners, which are named after
/// their daemons. What nobody has told is the identity.
class FrameTree {
public:
    ros::RobotModel &robot() { return robot_; }
    void setOdometry(const Pose2D &pose) { odometry_ = pose; }
    void setPose(const PoseMessage &message);

    /// foxglove.FrameTransforms of all.
    QJsonObject transforms(double stamp) const;

private:
    ros::RobotModel robot_{QString()};
    Pose2D odometry_, odometryInMap_;
};

} // namespace hermes::web
