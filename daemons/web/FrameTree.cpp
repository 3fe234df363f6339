#include "daemons/web/FrameTree.h"

#include <QJsonArray>
#include <algorithm>
#include <cmath>

namespace hermes::web {
namespace {

QJsonObject vectorOf(const Pose2D &pose) {
    return {{"x", pose.x}, {"y", pose.y}, {"z", 0}};
}

QJsonObject rotationOf(const ros::Quaternion &rotation) {
    return {{"x", rotation.x}, {"y", rotation.y}, {"z", rotation.z}, {"w", rotation.w}};
}

} // namespace

QJsonObject timeJson(double stamp) {
    const qint64 ns = std::llround(std::clamp(stamp, 0.0, 4e9) * 1e9);
    return {{"sec", ns / 1000000000}, {"nsec", ns % 1000000000}};
}

QJsonObject poseJson(const Pose2D &pose) {
    return {{"position", vectorOf(pose)}, {"orientation", rotationOf(ros::toQuaternion(pose.theta))}};
}

void FrameTree::setPose(const PoseMessage &message) {
    const Pose2D mount = robot_.matchedMount().value_or(ros::Mount()).pose;
    odometryInMap_ =
        message.odometryFrame ? *message.odometryFrame : message.pose * mount.inverse() * odometry_.inverse();
}

QJsonObject FrameTree::transforms(double stamp) const {
    QJsonArray all;
    const auto add = [&](const char *parent, const QString &child, const ros::Mount &place) {
        all.append(QJsonObject{{"timestamp", timeJson(stamp)},
                               {"parent_frame_id", parent},
                               {"child_frame_id", child},
                               {"translation", vectorOf(place.pose)},
                               {"rotation", rotationOf(ros::toQuaternion(place))}});
    };
    add("map", "odom", {odometryInMap_});
    add("odom", "base_link", {odometry_});
    for (const auto &[scanner, mount] : robot_.mounts())
        add("base_link", scanner, mount);
    return {{"transforms", all}};
}

} // namespace hermes::web
