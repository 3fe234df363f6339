#include "daemons/motorcontrol/Drive.h"

#include "protocol/wire/Fields.h"

#include <QLocale>
#include <algorithm>
#include <cmath>

namespace hermes::motorcontrol {
namespace {

const QString silentCause = QStringLiteral("time-out");
constexpr double longestStep_s = 0.1; // after a pause the ramp goes on, it does not make up for it
constexpr double rounding = 1e-9;     // relative

/// One value of a command and how large it may be.
struct Bounded {
    const char *name;
    double value;
    double limit;
    const char *unit;
    QString why = {}; ///< it may not be larger
};

template <typename Values>
Result<void> checkBounds(const Values &values) {
    QJsonArray errors;
    QString text;
    bool finite = true;
    for (const Bounded &v : values) {
        if (std::abs(v.value) <= v.limit)
            continue;
        finite = finite && std::isfinite(v.value);
        const QString bounds =
            v.limit > 0 ? QString("a number from %1 to %2 %3").arg(-v.limit).arg(v.limit).arg(v.unit) : "0";
        const QString expected = v.why.isEmpty() ? bounds : bounds + ": " + v.why;
        text += QString("%1%2 is %3, expected %4")
                    .arg(text.isEmpty() ? "" : "; ", v.name)
                    .arg(QString::number(v.value, 'g', QLocale::FloatingPointShortest), expected);
        errors.append(QJsonObject{{"path", v.name},
                                  {"value", std::isfinite(v.value) ? QJsonValue(v.value) : QJsonValue()},
                                  {"expected", expected}});
    }
    if (errors.isEmpty())
        return {};
    return Error(finite ? ErrorCode::OverLimit : ErrorCode::InvalidParams, text,
                 QJsonObject{{"errors", errors}});
}

} // namespace

void Drive::configure(const Settings &settings) {
    settings_ = settings;
    watchdog_.setTimeout(settings.commandTimeout_s);
    halt("settings", "the settings were changed");
}

Result<void> Drive::driveTwist(quint64 client, const Twist2D &twist, double age_s, double now) {
    const WheelLayout &layout = settings_.layout;
    const Twist2D &most = settings_.limits.velocity;
    const double turn = layout.steers()
                            ? std::min(most.omega, std::abs(twist.vx) / layout.leastRadius() * (1 + rounding))
                            : most.omega;
    const QString flat = layout.movesSideways() ? "" : "these wheels do not move the robot sideways";
    const QString wide = turn == most.omega
                             ? ""
                             : QString("the robot does not turn on the spot, its smallest radius is %1 m")
                                   .arg(layout.leastRadius(), 0, 'g', 3);
    const auto bounded =
        checkBounds(std::array<Bounded, 3>{{{"vx", twist.vx, most.vx, "m/s"},
                                            {"vy", twist.vy, flat.isEmpty() ? most.vy : 0, "m/s", flat},
                                            {"omega", twist.omega, turn, "rad/s", wide}}});
    if (!bounded)
        return bounded;
    const auto accepted =
        accept(client, saturated(layout.wheelSpeeds(twist), settings_.limits.wheelSpeed), age_s, now);
    if (accepted && layout.steers() && twist.vx != 0) // one that shall stand stays on its way
        targetSteering_ = layout.steering(twist.omega / twist.vx);
    if (accepted)
        turnsWheels_ = false;
    return accepted;
}

Result<void> Drive::driveWheels(quint64 client, const WheelValues &speeds, double age_s, double now) {
    WheelValues target = speeds;
    if (settings_.rearAsFront)
        std::copy_n(target.begin(), 2, target.begin() + 2);
    std::array<Bounded, wheelCount> values{};
    for (int i = 0; i < wheelCount; ++i) {
        const bool is = settings_.layout.has(i);
        values[i] = {wheelNames[i], target[i], is ? settings_.limits.wheelSpeed : 0, "rad/s",
                     is ? "" : "the layout has no such wheel"};
    }
    const auto bounded = checkBounds(values);
    const auto accepted = bounded ? accept(client, target, age_s, now) : bounded;
    if (accepted)
        turnsWheels_ = true;
    return accepted;
}

Result<void> Drive::mayMove(double age_s) const {
    if (latch_.isSet())
        return Error(latch_.has(emergencyCause) ? ErrorCode::NotReady : ErrorCode::DeviceFault,
                     latch_.text() + "; motor.reset_estop releases it", asJson(latch_.causes()));
    if (!notReady_.isEmpty())
        return Error(ErrorCode::DeviceFault, notReady_);
    if (!(std::abs(age_s) < settings_.commandTimeout_s))
        return Error(ErrorCode::NotReady,
                     QString("the command was made %1 s %2, expected less than %3 s from now: it "
                             "is late, or the clocks disagree")
                         .arg(std::abs(age_s))
                         .arg(age_s < 0 ? "from now" : "ago")
                         .arg(settings_.commandTimeout_s));
    return {};
}

Result<void> Drive::accept(quint64 client, const WheelValues &target, double age_s, double now) {
    const auto may = mayMove(age_s);
    if (!may)
        return may;
    const auto renewed = lease_.renew(client, now);
    if (!renewed)
        return renewed;
    target_ = target;
    haltCause_.clear();
    haltReason_.clear();
    deposed_ = 0;
    watchdog_.feed(now - std::max(0.0, age_s)); // time on the way counts
    return {};
}

void Drive::halt(const QString &cause, const QString &reason) {
    target_ = setPoint_ = {};
    const double most = settings_.layout.largestSteering();
    targetSteering_ = std::clamp(steering_, -most, most);
    watchdog_.rest();
    haltCause_ = cause;
    haltReason_ = reason;
}

void Drive::stop(quint64 client, const QString &who) {
    const quint64 driver = lease_.client();
    if (driver == 0 && client == deposed_) // its own stop is not why the robot stands
        return halt(QString(haltCause_), QString(haltReason_));
    if (driver != client)
        depose();
    halt(driver != 0 && driver == client ? "driver" : "stop", "stopped by " + who);
}

void Drive::depose() {
    if (lease_.client() != 0)
        deposed_ = lease_.client();
    lease_.revoke();
}

void Drive::emergencyStop(quint64 client, const QString &who, double now) {
    const bool isNew = latch_.set(emergencyCause, "emergency stop by " + who);
    presser_ = isNew || client == presser_ ? client : 0;
    if (isNew)
        stopped_ = lease_.isHeldBy(client) ? 0 : lease_.client();
    pressed_ = now;
    depose();
    halt(emergencyCause, latch_.reason(emergencyCause));
}

void Drive::restoreStop(const QString &reason, double now) {
    fault(emergencyCause, reason);
    presser_ = stopped_ = 0;
    pressed_ = now;
}

Result<void> Drive::mayReset(quint64 client, bool isConfirmed, double now) const {
    if (!latch_.has(emergencyCause))
        return {};
    const QString reason = latch_.reason(emergencyCause);
    const double left = pressed_ + holdOff_s - now;
    if (left > 0)
        return Error(ErrorCode::NotReady,
                     QString("%1: it was pressed %2 s ago, expected at least %3 s before it is released")
                         .arg(reason)
                         .arg(holdOff_s - left, 0, 'f', 2)
                         .arg(holdOff_s),
                     QJsonObject{{"retry_after_s", left}});
    if (client == presser_ && client != 0)
        return {};
    if (client == stopped_ && client != 0)
        return Error(ErrorCode::NotReady,
                     reason + ": it stopped this client, expected another one that releases it");
    if (isConfirmed)
        return {};
    return Error(ErrorCode::NotReady,
                 reason + ": not by this client alone, expected a person who has looked at the robot and "
                          "confirms, with confirm=true",
                 QJsonObject{{"confirm", true}});
}

void Drive::resetEmergencyStop(const QString &who) {
    latch_.release();
    ++resets_;
    lease_.revoke();
    halt("reset", (who.isEmpty() ? QString("released") : "released by " + who) + ", waits for a new lease");
}

Result<void> Drive::acquire(quint64 client, const QString &name, double timeout_s, double now, double age_s) {
    const auto may = mayMove(age_s);
    return may ? lease_.acquire(client, name, timeout_s, now) : may;
}

Result<void> Drive::takeOver(quint64 client, const QString &name, double timeout_s, double now,
                             double age_s) {
    const auto may = mayMove(age_s);
    if (!may)
        return may;
    if (const auto loser = lease_.takeOver(client, name, timeout_s, now))
        halt("take-over", QString("%1 took the control over from %2").arg(name, *loser));
    return {};
}

void Drive::ask(quint64 client, const QString &name) {
    lease_.ask(client, name);
}

void Drive::release(quint64 client) {
    if (lease_.release(client))
        halt("release", "the control was released");
}

void Drive::clientGone(quint64 client) {
    if (lease_.release(client))
        halt("client gone", "the client that held the control has gone");
}

void Drive::stoodStill(const QString &text) {
    lease_.revoke();
    halt("gap", text);
}

bool Drive::fault(const QString &name, const QString &reason) {
    if (!latch_.set(name, reason))
        return false;
    lease_.revoke();
    halt(name, reason);
    return true;
}

void Drive::setNotReady(const QString &why, const QString &cause) {
    if (notReady_ == why)
        return;
    notReady_ = why;
    lease_.revoke();
    halt(cause, why);
}

const WheelValues &Drive::step(double now) {
    const double dt = std::clamp(now - lastStep_, 0.0, longestStep_s);
    lastStep_ = now;
    if (const auto name = lease_.expire(now))
        halt(silentCause, QString("the control of %1 ran out").arg(*name));
    if (watchdog_.hasExpired(now))
        halt(silentCause, QString("no command for %1 s").arg(settings_.commandTimeout_s));
    if (dt > 0)
        advance(dt);
    return setPoint_;
}

void Drive::advance(double dt) {
    const WheelLayout &layout = settings_.layout;
    const MotionLimits &limits = settings_.limits;
    WheelValues next = target_;
    if (layout.steers() && !turnsWheels_) {
        const Bend bend = bent({layout.twist(setPoint_).vx, steering_},
                               {layout.twist(target_).vx, targetSteering_}, layout, limits, dt);
        steering_ = bend.steering;
        next = saturated(layout.wheelSpeeds({bend.speed, 0, bend.speed * layout.curvature(bend.steering)}),
                         limits.wheelSpeed);
    }
    setPoint_ = ramped(setPoint_, next, layout, limits.acceleration, dt);
}

} // namespace hermes::motorcontrol
