#include "daemons/recorder/CarmenText.h"

#include "protocol/messages/Turns.h"
#include "protocol/wire/Fields.h"

#include <algorithm>
#include <cmath>

namespace hermes::recorder {
namespace {

constexpr std::size_t keptSamples = 100; // two seconds
constexpr double maxRange_m = 200;       // no return
constexpr double longestGap_s = 0.5;     // between odometry and scan

QByteArray number(double value) {
    return ' ' + QByteArray::number(value, 'f', 6);
}

QByteArray poseText(const Pose2D &pose) {
    return number(pose.x) + number(pose.y) + number(pose.theta);
}

/// The ranges of a full turn, in as many directions as rays were fired, counted from that of the first point.
std::vector<double> rangesOf(const ScanMessage &scan, double start, std::size_t rays) {
    std::vector<double> ranges(rays, maxRange_m);
    for (std::size_t i = 0; i < scan.x.size(); ++i) {
        const double turned = std::atan2(double(scan.y[i]), double(scan.x[i])) - start;
        const auto ray = qint64(std::lround(turned / (2 * vectorlib::pi) * double(rays))) + qint64(rays);
        double &range = ranges[std::size_t(ray) % rays];
        range = std::min(range, std::hypot(double(scan.x[i]), double(scan.y[i])));
    }
    return ranges;
}

} // namespace

QStringList CarmenText::topics() {
    return {"motorcontrol/odometry", "velodynelogger/scan2d", "scanner*/scan2d", "scanmatcher/settings"};
}

QByteArray CarmenText::take(const SessionMessage &message) {
    if (message.name() == "odometry")
        return takeOdometry(message);
    if (message.name() == "scan2d")
        return takeScan(message);
    const WireValue data = message.data();
    const WireView sensor = data["sensor"];
    const Pose2D mount{sensor["x_m"].number(), sensor["y_m"].number(), sensor["theta_rad"].number()};
    if (std::isfinite(mount.x + mount.y + mount.theta))
        mount_ = mount;
    isUpsideDown_ = sensor["upside_down"].boolean();
    source_ = data["source"]["address"].text().section("//", -1);
    return {};
}

bool CarmenText::isMapped(const SessionMessage &message) {
    const auto address = message.channel.metadata.find("address");
    const bool isSource = address != message.channel.metadata.end() &&
                          QString::fromStdString(address->second).section("//", -1) == source_;
    if (isSource || topic_.isEmpty())
        topic_ = message.topic;
    return message.topic == topic_;
}

QByteArray CarmenText::takeOdometry(const SessionMessage &message) {
    ReadReport report;
    const auto odometry = readMessage<OdometryMessage>(message.data(), report);
    if (!odometry)
        return {};
    samples_.push_back({message.stamp, odometry->pose, odometry->twist});
    if (samples_.size() > keptSamples)
        samples_.pop_front();
    const QByteArray stamp = number(message.stamp);
    return "ODOM" + poseText(odometry->pose) + number(odometry->twist.vx) + number(odometry->twist.omega) +
           " 0" + stamp + " hermes" + stamp + '\n';
}

std::optional<Pose2D> CarmenText::robotAt(double stamp) const {
    const auto later =
        std::find_if(samples_.rbegin(), samples_.rend(), [&](const Sample &s) { return s.stamp <= stamp; });
    if (later == samples_.rend() || stamp - later->stamp > longestGap_s)
        return std::nullopt;
    return later->pose * later->twist.motion(stamp - later->stamp);
}

QByteArray CarmenText::takeScan(const SessionMessage &message) {
    ReadReport report;
    auto scan = readMessage<ScanMessage>(message.data(), report);
    if (!isMapped(message) || !scan || scan->header.partial || scan->x.empty() ||
        scan->y.size() != scan->x.size())
        return {};
    for (float &y : scan->y)
        y = isUpsideDown_ ? -y : y;
    const double middle =
        scan->header.stamp + scan->header.duration_s / 2; // to which the ray in the middle belongs
    const auto robot = robotAt(middle);
    const std::size_t rays = std::clamp<std::size_t>(scan->header.rays.value_or(scan->x.size()), 2, 100000);
    const double start = std::atan2(double(scan->y[0]), double(scan->x[0]));
    if (!robot || !std::isfinite(start))
        return {};
    ++scans_;
    QByteArray line = "ROBOTLASER1 0" + number(start) + number(2 * vectorlib::pi) + ' ' +
                      QByteArray::number(2 * vectorlib::pi / double(rays), 'g', 17) + number(maxRange_m) +
                      " 0.02 0 " + QByteArray::number(qulonglong(rays));
    for (const double range : rangesOf(*scan, start, rays))
        line += ' ' + QByteArray::number(range, 'f', 3);
    const QByteArray stamp = number(middle);
    return line + " 0" + poseText(*robot * mount_) + poseText(*robot) + " 0 0 0 0 0" + stamp + " hermes" +
           stamp + '\n';
}

} // namespace hermes::recorder
