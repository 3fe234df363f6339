#include "gui/hermesctl/WheelTest.h"

#include "common/daemon/SignalWatcher.h"
#include "gui/hermesctl/Driver.h"
#include "gui/hermesctl/Question.h"

#include <optional>

namespace hermes::ctl {
namespace {

constexpr double speed = 1; // rad/s
constexpr double turn_s = 1;
constexpr double settled_s = 0.5; // then it has the speed that was asked for
const QString choices =
    "Enter: it turned forward; b: backward; fl, fr, rl, rr: that one turned instead (flb: "
    "backward); n: none; q: give up";

QString initials(const QString &wheel) {
    return wheel.left(1) + wheel.section('_', 1).left(1);
}

/// The mean speed that the encoder of a wheel tells while it turns, in rad/s.
Result<double> turn(Client &motors, const Arguments &arguments, const QString &wheel) {
    double sum = 0;
    int count = 0;
    QElapsedTimer turning;
    Driver driver(motors, arguments, "motor.wheels", [&] {
        if (!turning.isValid())
            turning.start();
        return QJsonObject{{wheel, speed}};
    });
    driver.endAfter(turn_s);
    SignalWatcher signals(nullptr);
    bool isGivenUp = false;
    QObject::connect(&signals, &SignalWatcher::received, &motors, [&] {
        isGivenUp = true;
        driver.end();
    });
    const int wheels = motors.subscribe("wheels", {{"queue", 1}}, [&](const TopicUpdate &update) {
        const double seconds = turning.isValid() ? double(turning.elapsed()) / 1000 : 0;
        if (seconds < settled_s || seconds > turn_s) // it speeds up, or brakes
            return;
        sum += update.json()[wheel]["speed"].toDouble();
        ++count;
    });
    const auto turned = driver.run();
    motors.unsubscribe(wheels);
    if (!turned)
        return turned.error();
    if (isGivenUp)
        return Error(ErrorCode::NotReady, "the test of the wheels was given up");
    return count > 0 ? sum / count : 0;
}

} // namespace

const QStringList &wheelNames() {
    static const QStringList names{"front_left", "front_right", "rear_left", "rear_right"};
    return names;
}

std::optional<SeenWheel> seenWheel(const QString &told, const QString &answer) {
    if (answer == "n")
        return SeenWheel{};
    if (answer.isEmpty() || answer == "b")
        return SeenWheel{told, answer == "b"};
    for (const QString &wheel : wheelNames())
        if (answer == initials(wheel) || answer == initials(wheel) + 'b')
            return SeenWheel{wheel, answer.size() == 3};
    return std::nullopt;
}

Result<QJsonObject> wheelSettings(const QJsonObject &now, const std::map<QString, SeenWheel> &seen) {
    QJsonObject wheels;
    for (const auto &[told, what] : seen) {
        if (what.wheel.isEmpty())
            return Error(
                ErrorCode::DeviceFault,
                QString("no wheel turned for %1: look at the power and the wires of that motor").arg(told));
        if (wheels.contains(what.wheel))
            return Error(
                ErrorCode::DeviceFault,
                QString("%1 turned for two of the wheels: the settings cannot be told").arg(what.wheel));
        QJsonObject wheel = now[told].toObject();
        wheel["reversed"] = wheel["reversed"].toBool() != what.isBackward;
        wheels[what.wheel] = wheel;
    }
    QJsonObject changes;
    for (const QString &wheel : wheels.keys())
        if (wheels[wheel] != now[wheel])
            changes[wheel] = wheels[wheel];
    return changes;
}

Result<QJsonObject> testWheels(Client &motors, const Arguments &arguments) {
    const auto settings =
        motors.callAndWait("settings.get", QJsonObject{{"path", "wheels"}}, arguments.timeout);
    if (!settings)
        return settings.error();
    if (const auto ready = waitUntilReady(motors, arguments); !ready)
        return ready.error();
    std::map<QString, SeenWheel> seen;
    for (const QString &wheel : wheelNames()) {
        note(QString("%1 is told to turn forward, at %2 rad/s for %3 s").arg(wheel).arg(speed).arg(turn_s));
        const auto measured = turn(motors, arguments, wheel);
        if (!measured)
            return Error(
                measured.error().code == int(ErrorCode::NotReady) ? ErrorCode::NotReady
                                                                  : ErrorCode::DeviceFault,
                QString("%1: %2; where its encoder counts against its motor, or not at all, swap the "
                        "wires A and B of the encoder, or connect it")
                    .arg(wheel, measured.error().message));
        note(QString("its encoder tells %1 rad/s").arg(*measured, 0, 'f', 2));
        std::optional<SeenWheel> one;
        while (!one) {
            const QString answer = answerTo(QString("What turned? %1:").arg(choices));
            if (answer == "q")
                return Error(ErrorCode::NotReady, "the test of the wheels was given up");
            one = seenWheel(wheel, answer);
        }
        seen[wheel] = *one;
    }
    return wheelSettings(settings->toObject(), seen);
}

} // namespace hermes::ctl
