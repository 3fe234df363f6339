#include "daemons/motorcontrol/MotorJson.h"

#include "protocol/roboclaw/Status.h"

#include <QJsonArray>
#include <algorithm>

namespace hermes {
namespace {

QString notStanding(const Telemetry::Controller &c) {
    return c.error.isEmpty()
               ? QString("its wheels turn, or it was not read since: its line may be silent for another one")
               : c.error;
}

} // namespace

bool allStand(const Telemetry &t) {
    return std::all_of(t.controllers.begin(), t.controllers.end(), [](const auto &c) { return c.stands; });
}

QJsonObject toJson(const Pose &pose) {
    return {{"x", pose.x}, {"y", pose.y}, {"theta", pose.theta}};
}

QJsonObject toJson(const Twist &twist) {
    return {{"vx", twist.vx}, {"vy", twist.vy}, {"omega", twist.omega}};
}

OdometryMessage odometryOf(const Telemetry &t) {
    return {t.pose, t.twist, t.covariance, t.mono};
}

QJsonObject wheelsJson(const Telemetry &t) {
    QJsonObject json{{"slip", t.slip}};
    for (int i = 0; i < wheelCount; ++i)
        json.insert(wheelNames[i], QJsonObject{{"target", t.target[i]},
                                               {"set_point", t.setPoint[i]},
                                               {"speed", t.speeds[i]},
                                               {"angle", t.turns[i]}});
    return json;
}

QJsonObject powerJson(const Telemetry &t) {
    QJsonArray controllers;
    for (const Telemetry::Controller &controller : t.controllers) {
        const ControllerReadings &r = controller.readings;
        QJsonArray meanings;
        for (quint32 bit = 1; bit != 0; bit <<= 1) {
            if (r.status & bit)
                meanings.append(roboclaw::statusText(bit));
        }
        controllers.append(QJsonObject{{"ready", controller.ready && r.complete},
                                       {"battery_v", r.battery_v},
                                       {"logic_v", r.logic_v},
                                       {"current_a", QJsonArray{r.current_a[0], r.current_a[1]}},
                                       {"temperature_c", r.temperature_c},
                                       {"status", qint64(r.status)},
                                       {"status_texts", meanings}});
    }
    return {{"controllers", controllers}};
}

QJsonObject controllerJson(const Telemetry::Controller &c) {
    return {{"name", c.name},
            {"ready", c.ready},
            {"confirmed", c.stands},
            {"error", c.error},
            {"version", c.version},
            {"requests", double(c.counts.sent)},
            {"answers", double(c.counts.done)},
            {"timeouts", double(c.counts.timeouts)},
            {"crc_errors", double(c.counts.crcErrors)},
            {"unexpected", double(c.counts.unexpected)},
            {"stray_bytes", double(c.strayBytes)},
            {"rate_hz", c.rate_Hz},
            {"overruns", double(c.overruns)}};
}

QString notConfirmedText(const Telemetry &t) {
    QStringList texts;
    for (const Telemetry::Controller &c : t.controllers) {
        if (!c.stands)
            texts.append(c.name + " is not confirmed to stand: " + notStanding(c));
    }
    return texts.join("; ");
}

QJsonObject cycleJson(const Telemetry &telemetry, double period_s) {
    const CycleStatistics &cycle = telemetry.cycle;
    return {{"period_s", period_s},
            {"cycles", double(cycle.cycles)},
            {"missed", double(cycle.missed)},
            {"mean_lateness_s", cycle.meanLateness_s},
            {"worst_lateness_s", cycle.worstLateness_s},
            {"unread", double(telemetry.unread)},
            {"realtime", telemetry.realtime}};
}

QJsonObject standingJson(const Telemetry &t) {
    QJsonArray controllers;
    for (const Telemetry::Controller &c : t.controllers)
        controllers.append(QJsonObject{
            {"name", c.name}, {"confirmed", c.stands}, {"reason", c.stands ? QString() : notStanding(c)}});
    return {{"confirmed", allStand(t)}, {"text", notConfirmedText(t)}, {"controllers", controllers}};
}

} // namespace hermes
