#include "common/ros/States.h"

#include <QString>
#include <cmath>

namespace hermes::ros {
namespace {

constexpr double bodyHeight = 0.15, sensorHeight = 0.25, wheelWidth = 0.06,
                 sensorRadius = 0.05; // m: settings tell none

QString link(const std::string &name, const QString &geometry, const QString &origin, const QString &color) {
    return QString("  <link name=\"%1\">\n    <visual>\n      <origin %2/>\n      <geometry>%3</geometry>\n"
                   "      <material name=\"%4\"/>\n    </visual>\n  </link>\n")
        .arg(QString::fromStdString(name).toHtmlEscaped(), origin, geometry, color);
}

QString joint(const std::string &name, const QString &type, const std::string &parent,
              const std::string &child, const QString &origin) {
    return QString("  <joint name=\"%1\" type=\"%2\">\n    <parent link=\"%3\"/>\n    <child link=\"%4\"/>\n"
                   "    <origin %5/>\n    <axis xyz=\"0 1 0\"/>\n  </joint>\n")
        .arg(QString::fromStdString(name).toHtmlEscaped(), type,
             QString::fromStdString(parent).toHtmlEscaped(), QString::fromStdString(child).toHtmlEscaped(),
             origin);
}

QString originOf(const Pose2D &pose, double z, double roll) {
    return QString("xyz=\"%1 %2 %3\" rpy=\"%4 0 %5\"")
        .arg(pose.x)
        .arg(pose.y)
        .arg(z)
        .arg(roll)
        .arg(pose.theta);
}

} // namespace

std::string urdfOf(const RobotModel &robot) {
    QString text = "<?xml version=\"1.0\"?>\n<robot name=\"hermes\">\n"
                   "  <material name=\"body\"><color rgba=\"0.2 0.4 0.7 1\"/></material>\n"
                   "  <material name=\"dark\"><color rgba=\"0.15 0.15 0.15 1\"/></material>\n";
    const double clearance = robot.wheels().empty() ? 0 : robot.wheels().front().radius;
    text += link(robot.baseFrame(),
                 QString("<box size=\"%1 %2 %3\"/>")
                     .arg(2 * robot.halfLength())
                     .arg(2 * robot.halfWidth())
                     .arg(bodyHeight),
                 QString("xyz=\"0 0 %1\"").arg(clearance + bodyHeight / 2), "body");
    for (const WheelPlace &wheel : robot.wheels()) {
        const std::string name = robot.frame(wheel.name + "_wheel");
        text +=
            link(name, QString("<cylinder radius=\"%1\" length=\"%2\"/>").arg(wheel.radius).arg(wheelWidth),
                 QString("rpy=\"%1 0 0\"").arg(M_PI / 2), "dark");
        text += joint(wheel.name + "_wheel_joint", "continuous", robot.baseFrame(), name,
                      originOf(wheel.pose, wheel.radius, 0));
    }
    for (const auto &[daemon, mount] : robot.mounts()) {
        const std::string name = robot.sensorFrame(daemon);
        text += link(name, QString("<cylinder radius=\"%1\" length=\"%1\"/>").arg(sensorRadius),
                     QString("xyz=\"0 0 %1\"").arg(sensorHeight), "dark");
        text += joint(daemon.toStdString() + "_joint", "fixed", robot.baseFrame(), name,
                      originOf(mount.pose, 0, mount.isUpsideDown ? M_PI : 0));
    }
    return (text + "</robot>\n").toStdString();
}

} // namespace hermes::ros
