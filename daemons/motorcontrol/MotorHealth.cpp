// What the motor control tells about itself: health items, state, motor.state.
#include "common/Time.h"
#include "daemons/motorcontrol/MotorControl.h"
#include "daemons/motorcontrol/MotorMessages.h"
#include "protocol/wire/Fields.h"
#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <cmath>

namespace hermes::motorcontrol {
namespace {

constexpr double lateness_s = 0.005; // more of it is worth a look
constexpr double slowRate_Hz = 40;   // less of what a line should give at 50 Hz, too

constexpr double stickiness = 1.2; // of the warning of a battery that runs out

QString textOf(const BatteryState &battery) {
    if (!battery.left_s)
        return "charge not known: " + battery.reason;
    return QString("charge %1 % (+- %2), %3 min left at %4 A")
        .arg(std::lround(100 * *battery.charge))
        .arg(std::lround(100 * *battery.chargeDeviation))
        .arg(std::lround(*battery.left_s / 60))
        .arg(*battery.current_a, 0, 'f', 1);
}

HealthLevel toHealth(Threshold::Level level) {
    switch (level) {
    case Threshold::Level::Good:
        return HealthLevel::Ok;
    case Threshold::Level::Warning:
        return HealthLevel::Warn;
    case Threshold::Level::Fault:
        break;
    }
    return HealthLevel::Failed;
}

} // namespace

void MotorControl::updateHealth() {
    tellControllers();
    tellMeasures();
    tellCycle();
    tellSlowWheels();
    tellStop();
}

// Of a controller whose time-out cannot be set: what that means.
QString MotorControl::runOnOf(std::size_t controller) const {
    const Telemetry::Controller &c = told_.controllers[controller];
    if (!c.ready || active_.controllers[controller].model->timeout.isSet)
        return {};
    if (!c.timeout_s)
        return "; when this program dies it never stops by itself";
    return QString("; when this program dies it stops by itself after %1 s%2, %3 %4 m farther")
        .arg(*c.timeout_s)
        .arg(c.coasts ? " and rolls" : "", c.coasts ? "at least" : "up to")
        .arg(active_.longestWay_m(*c.timeout_s), 0, 'f', 1);
}

void MotorControl::tellControllers() {
    for (std::size_t i = 0; i < told_.controllers.size(); ++i) {
        const Telemetry::Controller &c = told_.controllers[i];
        const QString advice = c.advice.isEmpty() ? QString() : "; " + c.advice;
        const QString text = c.name + ": " + (c.ready ? c.version : c.error) + advice + runOnOf(i);
        const quint64 faults = c.counts.timeouts + c.counts.crcErrors + c.counts.unexpected;
        const HealthLevel past = answers_[i].level(double(faults));
        const HealthLevel level = !c.ready                            ? HealthLevel::Failed
                                  : c.advice.isEmpty() && c.timeout_s ? past
                                                                      : HealthLevel::Warn;
        const QString pastText =
            faults > 0 ? QString("; %1 answers were damaged or did not come").arg(faults) : QString();
        health().set(QString("controller_%1").arg(i + 1), level, text + pastText, asJson(c).toObject());
    }
}

void MotorControl::tellMeasures() {
    double battery = 1e9, current = 0, temperature = -1e9;
    bool known = false;
    for (const Telemetry::Controller &c : told_.controllers) {
        if (!c.ready || !c.readings.complete)
            continue;
        known = true;
        battery = std::min(battery, c.readings.battery_v);
        temperature = std::max(temperature, c.readings.temperature_c);
        for (double a : c.readings.current_a)
            current = std::max(current, std::abs(a));
    }
    const DeviceModel &model = *active_.controllers[0].model;
    const auto measured = [&](int item, const char *name, double value, const char *key, const char *unit,
                              const Threshold::Settings &limits, bool warns = false,
                              const QString &more = QString()) {
        if (!model.measures[std::size_t(item)])
            return health().set(name, HealthLevel::Ok, QString(model.title) + " does not measure it");
        if (!known)
            return health().set(name, HealthLevel::Stale, "no controller has reported it");
        const HealthLevel level = toHealth(told_.levels[item]);
        health().set(name, warns && level == HealthLevel::Ok ? HealthLevel::Warn : level,
                     QString("%1 %2").arg(value).arg(unit) + more,
                     {{key, value}, {"warning", limits.warning}, {"fault", limits.fault}});
    };
    const BatteryState &gauge = gauge_.state();
    runsOut_ = gauge.left_s && *gauge.left_s < active_.batteryWarning_s * (runsOut_ ? stickiness : 1);
    const bool isDoubtful = isReady() && model.measures[3] && !gauge_.missing().isEmpty();
    measured(0, "battery", battery, "battery_v", "V", active_.battery, runsOut_ || isDoubtful,
             ", " + textOf(gauge));
    measured(1, "current", current, "current_a", "A", active_.current);
    measured(2, "temperature", temperature, "temperature_c", "degrees Celsius", active_.temperature);
}

void MotorControl::tellCycle() {
    const CycleStatistics &cycle = told_.cycle;
    const bool late = cycle.worstLateness_s > lateness_s;
    QString text = QString("50 Hz, at worst %1 ms late in the last second, %2 cycles missed")
                       .arg(1000 * cycle.worstLateness_s, 0, 'f', 2)
                       .arg(cycle.missed);
    bool slow = false;
    for (const Telemetry::Controller &c : told_.controllers) {
        if (!c.ready || c.rate_Hz == 0 || c.rate_Hz > slowRate_Hz)
            continue;
        slow = true;
        text += QString("; the line of %1 gives %2 Hz: its answers come late")
                    .arg(c.name)
                    .arg(c.rate_Hz, 0, 'f', 1);
    }
    health().set("cycle", late || slow ? HealthLevel::Warn : HealthLevel::Ok, text,
                 asJson(cycleOf(told_)).toObject());
}

// A wheel that stands instead makes the robot go another way than it was told.
void MotorControl::tellSlowWheels() {
    const DeviceModel &model = *active_.controllers[0].model;
    const double slowest = model.slowest(active_.device()) * 2 * vectorlib::pi / active_.countsPerTurn;
    QStringList slow;
    for (std::size_t i = 0; i < told_.target.size(); ++i)
        if (told_.target[i] != 0 && std::abs(told_.target[i]) < slowest)
            slow.append(QString("%1 at %2 rad/s").arg(wheelNames[i]).arg(told_.target[i], 0, 'f', 2));
    health().set("wheels", slow.isEmpty() ? HealthLevel::Ok : HealthLevel::Warn,
                 slow.isEmpty() ? QString("not told to turn slower than they can")
                                : QString("told to turn slower than the %1 rad/s that %2 can: %3; the robot "
                                          "goes another way")
                                      .arg(slowest, 0, 'f', 2)
                                      .arg(model.title, slow.join(", ")));
}

void MotorControl::tellStop() {
    const bool latched = told_.latch.isSet();
    const auto &causes = told_.latch.causes();
    QStringList texts{latched ? told_.latch.text() : QString("no emergency stop")};
    const bool lost = !isReady() && !allStand(told_); // while it brakes it is ready
    if (lost)
        texts.append(standingOf(told_).all.text);
    if (!unkept_.isEmpty())
        texts.append(unkept_);
    if (!told_.unopened.isEmpty())
        texts.append("nothing is driven: " + told_.unopened);
    const HealthLevel level = latched || lost     ? HealthLevel::Failed
                              : texts.size() == 1 ? HealthLevel::Ok
                                                  : HealthLevel::Warn;
    health().set("stop", level, texts.join("; "), asJson(causes).toObject());
    const bool fault = causes.size() > int(told_.latch.has(Drive::emergencyCause));
    setState(fault ? DaemonState::Fault : isReady() && !latched ? DaemonState::Running : DaemonState::Ready);
}

bool MotorControl::isReady() const {
    return std::all_of(told_.controllers.begin(), told_.controllers.end(),
                       [](const Telemetry::Controller &c) { return c.ready; });
}

MotorState MotorControl::state() const {
    const WheelLayout &layout = active_.drive.layout;
    std::optional<double> timeout_s = 0;
    for (const Telemetry::Controller &c : told_.controllers)
        timeout_s =
            timeout_s && c.timeout_s ? std::optional(std::max(*timeout_s, *c.timeout_s)) : std::nullopt;
    return {isReady(),
            standingOf(told_),
            told_.latch.has(Drive::emergencyCause),
            holdOf(told_),
            told_.pose,
            told_.twist,
            layout.twist(told_.target, told_.targetSteering),
            layout.twist(told_.setPoint, told_.steering),
            wheelsOf(told_, layout),
            told_.counterJumps,
            timeout_s ? std::optional(active_.longestWay_m(*timeout_s)) : std::nullopt,
            layout.movesSideways(),
            layout.leastRadius(),
            {told_.controllers.begin(), told_.controllers.end()},
            cycleOf(told_),
            gauge_.state()};
}

} // namespace hermes::motorcontrol
