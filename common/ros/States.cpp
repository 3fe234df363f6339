#include "common/ros/States.h"

#include <cmath>

namespace hermes::ros {
namespace {

constexpr double deviationPerDilution = 5; // m: of a usual receiver, for each unit of its HDOP

Octet levelOf(const QString &level) {
    using S = DiagnosticStatus;
    return Octet(level == "ok" ? S::Ok : level == "warn" ? S::Warn : level == "error" ? S::Error : S::Stale);
}

std::string textOf(const QJsonValue &value) {
    if (value.isString())
        return value.toString().toStdString();
    const QByteArray whole = QJsonDocument(QJsonArray{value}).toJson(QJsonDocument::Compact);
    return whole.mid(1, whole.size() - 2).toStdString();
}

DiagnosticStatus statusOf(const QString &daemon, const HealthItem &item) {
    DiagnosticStatus status;
    status.level = levelOf(item.level);
    status.name = (daemon + ": " + item.name).toStdString();
    status.message = item.message.toStdString();
    status.hardwareId = daemon.toStdString();
    for (auto value = item.values.begin(); value != item.values.end(); ++value)
        status.values.push_back({value.key().toStdString(), textOf(value.value())});
    return status;
}

} // namespace

bool BatteryOf::operator()(const PowerMessage &in, const Told &told, BatteryState &out) {
    out = {};
    out.header = headerOf(told.stamp, told.robot.baseFrame());
    double volts = 0;
    int answering = 0;
    for (const ControllerPower &controller : in.controllers)
        if (controller.ready) {
            volts += controller.battery_v;
            ++answering;
        }
    out.present = answering > 0;
    if (answering > 0)
        out.voltage = float(volts / answering);
    if (in.battery.charge)
        out.percentage = float(*in.battery.charge);
    if (in.battery.current_a) {
        out.current = -float(*in.battery.current_a);
        out.status = *in.battery.current_a > 0 ? 2 : 0; // it is discharged; what charges it is not known
    }
    return true;
}

bool FixOf::operator()(const FixMessage &in, const Told &told, NavSatFix &out) {
    const FixValues &fix = in.values;
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    out = {};
    out.header = headerOf(told.stamp, told.robot.baseFrame());
    const bool isThere = fix.valid && fix.lat_deg && fix.lon_deg;
    const int quality = fix.quality.value_or(1);
    out.status.status = !isThere ? -1 : quality == 2 ? 1 : quality == 4 || quality == 5 ? 2 : 0;
    out.latitude = isThere ? *fix.lat_deg : unknown;
    out.longitude = isThere ? *fix.lon_deg : unknown;
    out.altitude = unknown;
    if (isThere && fix.hdop) {
        const double variance = std::pow(deviationPerDilution * *fix.hdop, 2);
        out.positionCovariance = {variance, 0, 0, 0, variance, 0, 0, 0, 4 * variance};
        out.positionCovarianceType = 1;
    }
    return true;
}

bool LogOf::operator()(const LogMessage &in, const Told &told, Log &out) {
    using L = Log;
    out.stamp = toTime(in.stamp);
    out.level = in.level == "error"     ? L::Error
                : in.level == "warning" ? L::Warn
                : in.level == "debug"   ? L::Debug
                                        : L::Info;
    out.name = (told.daemon + '.' + in.source).toStdString();
    out.message = in.text.toStdString();
    return true;
}

bool Diagnostics::take(const TopicUpdate &update, const Told &told, std::string &, QString &problem) {
    ReadReport report;
    const auto status = readMessage<DaemonStatus>(update.data, report);
    if (!status) {
        problem = report.text();
        return false;
    }
    std::vector<DiagnosticStatus> &own = all_[told.daemon];
    own.clear();
    for (const HealthItem &item : status->health)
        own.push_back(statusOf(told.daemon, item));
    HealthItem whole;
    whole.name = "state";
    whole.message = status->state;
    whole.level = status->state == "fault" ? "error" : status->state == "degraded" ? "warn" : "ok";
    own.push_back(statusOf(told.daemon, whole));
    return false;
}

bool Diagnostics::refresh(const RobotModel &, double now, std::string &cdr) {
    DiagnosticArray array;
    array.header = headerOf(now, {});
    for (const auto &[daemon, items] : all_)
        array.status.insert(array.status.end(), items.begin(), items.end());
    toCdr(array, cdr);
    return !array.status.empty();
}

void Diagnostics::lose(const QString &daemon) {
    const auto found = all_.find(daemon);
    if (found == all_.end())
        return;
    HealthItem gone;
    gone.name = "state";
    gone.message = "it does not answer any more";
    gone.level = "stale";
    found->second = {statusOf(daemon, gone)};
}

bool Description::refresh(const RobotModel &robot, double, std::string &cdr) {
    if (std::exchange(revision_, robot.revision()) == robot.revision())
        return false;
    toCdr(String{urdfOf(robot)}, cdr);
    return true;
}

} // namespace hermes::ros
