#include "common/ros/RobotModel.h"

#include <QUrl>
#include <cmath>

namespace hermes::ros {
namespace {

/// Of "HOST:PORT" or a URL; 0: none.
int portOf(const QString &address) {
    return QUrl(address.contains("//") ? address : "tcp://" + address).port(0);
}

Mount mountOf(const QJsonObject &sensor) {
    return {{sensor["x_m"].toDouble(), sensor["y_m"].toDouble(), sensor["theta_rad"].toDouble()},
            sensor["upside_down"].toBool()};
}

} // namespace

void RobotModel::addScanner(const QString &daemon, const QString &address) {
    const int port = portOf(address);
    const auto [scanner, isNew] = scanners_.emplace(daemon, port);
    if (isNew || std::exchange(scanner->second, port) != port)
        ++revision_;
}

void RobotModel::takeSettings(const QString &daemon, const QJsonObject &settings) {
    if (daemon.startsWith("scanmatcher")) {
        matched_.clear();
        for (const auto &[source, sensor] : {std::pair("source", "sensor"), std::pair("source2", "sensor2")})
            if (const int port = portOf(settings[source].toObject()["address"].toString()); port != 0)
                matched_.push_back({port, mountOf(settings[sensor].toObject())});
    } else if (daemon.startsWith("motorcontrol")) {
        takeWheels(settings["frame"].toObject());
    } else {
        return;
    }
    ++revision_;
}

void RobotModel::takeWheels(const QJsonObject &frame) {
    const double a = frame["half_base_m"].toDouble(0.25), b = frame["half_track_m"].toDouble(0.25);
    const double radius = frame["wheel_radius_m"].toDouble(0.1);
    const QString layout = frame["layout"].toString();
    wheels_.clear();
    if (layout.startsWith("omni")) {
        const int count = layout == "omni3" ? 3 : 4;
        const double distance = frame["omni_radius_m"].toDouble(0.2);
        const double first = frame["omni_angle_rad"].toDouble();
        const char *const names[] = {"front_left", "rear_left", "rear_right", "front_right"};
        for (int i = 0; i < count; ++i) {
            const double angle = first + 2 * M_PI * i / count;
            wheels_.push_back({names[i],
                               {distance * std::cos(angle), distance * std::sin(angle), angle + M_PI / 2},
                               radius});
        }
        halfLength_ = halfWidth_ = distance + radius / 2;
        return;
    }
    const bool hasTwo = layout == "two_wheels";
    const double front = hasTwo ? 0 : a;
    wheels_ = {{"front_left", {front, b, 0}, radius}, {"front_right", {front, -b, 0}, radius}};
    if (!hasTwo) {
        wheels_.push_back({"rear_left", {-a, b, 0}, radius});
        wheels_.push_back({"rear_right", {-a, -b, 0}, radius});
    }
    halfLength_ = (hasTwo ? b : a) + radius;
    halfWidth_ = b;
}

std::map<QString, Mount> RobotModel::mounts() const {
    std::map<QString, Mount> all;
    for (const auto &[daemon, port] : scanners_) {
        all[daemon] = {};
        for (const Matched &one : matched_)
            if (one.port == port)
                all[daemon] = one.mount;
    }
    return all;
}

std::optional<bool> RobotModel::isMatched(const QString &scanner) const {
    const auto found = scanners_.find(scanner);
    if (matched_.empty() || found == scanners_.end())
        return std::nullopt;
    return found->second == matched_.front().port;
}

std::optional<Mount> RobotModel::matchedMount() const {
    return matched_.empty() ? std::nullopt : std::optional(matched_.front().mount);
}

Time toTime(double stamp) {
    const double seconds = std::floor(stamp);
    Time time;
    time.sec = std::int32_t(std::max(-2147483648.0, std::min(2147483647.0, seconds)));
    time.nanosec = std::min(999999999u, std::uint32_t(std::lround((stamp - seconds) * 1e9)));
    return time;
}

Header headerOf(double stamp, const std::string &frame) {
    return {toTime(stamp), frame};
}

Quaternion toQuaternion(double theta) {
    return {0, 0, std::sin(theta / 2), std::cos(theta / 2)};
}

/// Upside down: turned by half a revolution about its own x axis.
Quaternion toQuaternion(const Mount &mount) {
    const double s = std::sin(mount.pose.theta / 2), c = std::cos(mount.pose.theta / 2);
    return mount.isUpsideDown ? Quaternion{c, s, 0, 0} : Quaternion{0, 0, s, c};
}

Pose toPose(const Pose2D &pose) {
    return {{pose.x, pose.y, 0}, toQuaternion(pose.theta)};
}

Transform toTransform(const Pose2D &pose) {
    return {{pose.x, pose.y, 0}, toQuaternion(pose.theta)};
}

} // namespace hermes::ros
