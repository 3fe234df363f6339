#include "gui/hermesctl/WheelTest.h"

#include "common/daemon/SignalWatcher.h"
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/Question.h"
#include "gui/setup/WheelTurn.h"

#include <QEventLoop>
#include <QHostInfo>
#include <optional>

namespace hermes::ctl {
namespace {

const QString choices =
    "Enter: it turned forward; b: backward; fl, fr, rl, rr: that one turned instead (flb: "
    "backward); n: none; q: give up";

QString initials(const QString &wheel) {
    return wheel.left(1) + wheel.section('_', 1).left(1);
}

/// The mean speed that the encoder of a wheel tells while it turns, in rad/s.
Result<double> turn(Client &motors, const Arguments &arguments, const QString &wheel) {
    QEventLoop loop;
    Result<double> measured = 0.0;
    WheelTurn turn(motors, "hermesctl on " + QHostInfo::localHostName(), arguments.timeout);
    SignalWatcher signals(nullptr);
    QObject::connect(&signals, &SignalWatcher::received, &turn, &WheelTurn::giveUp);
    turn.begin(wheel, [&](const Result<double> &result) {
        measured = result;
        loop.quit();
    });
    loop.exec();
    return measured;
}

} // namespace

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

Result<QJsonObject> testWheels(Client &motors, const Arguments &arguments) {
    const auto settings =
        motors.callAndWait("settings.get", QJsonObject{{"path", "wheels"}}, arguments.timeout);
    if (!settings)
        return settings.error();
    std::map<QString, SeenWheel> seen;
    for (const QString &wheel : wheelNames()) {
        note(QString("%1 is told to turn forward, at %2 rad/s for %3 s")
                 .arg(wheel)
                 .arg(WheelTurn::speed)
                 .arg(WheelTurn::turn_s));
        const auto measured = turn(motors, arguments, wheel);
        if (!measured)
            return measured.error();
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
