// hermesctl drive: the robot moves as long as this runs.
#include "common/Time.h"
#include "common/daemon/SignalWatcher.h"
#include "common/platform/Console.h"
#include "common/platform/Pipes.h"
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/DriveKeys.h"
#include "gui/hermesctl/Driver.h"
#include "gui/hermesctl/KeyTerminal.h"
#include "gui/hermesctl/Nearest.h"
#include "gui/hermesctl/Waiting.h"
#include "protocol/wire/Fields.h"

#include <QElapsedTimer>
#include <QTimer>
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hermes::ctl {
namespace {

constexpr double degree = 0.017453292519943295;
constexpr std::chrono::milliseconds beat{50};
constexpr double usualDrive_s = 10; ///< a drive with a velocity has an end
constexpr qint64 frozen_ms = 200;   ///< between two beats: this program stood still

Result<Pose2D> poseOf(Client &client, const Arguments &arguments) {
    const auto state = ask(client, arguments, "motor.state");
    if (!state)
        return state.error();
    ReadReport report;
    const auto pose = readMessage<Pose2D>(WireValue((*state)["pose"]), report);
    if (!pose)
        return Error(ErrorCode::InternalError, "motor.state: pose: " + report.text());
    return *pose;
}

QString text(const Pose2D &pose) {
    return QString("x %1 m, y %2 m, heading %3 degrees")
        .arg(pose.x, 0, 'f', 3)
        .arg(pose.y, 0, 'f', 3)
        .arg(pose.theta / degree, 0, 'f', 1);
}

/// Of the tightest bend, metres; 0: the robot turns on the spot, or does not tell.
double leastRadiusOf(Client &client, const Arguments &arguments) {
    const auto state = ask(client, arguments, "motor.state");
    return state ? (*state)["least_radius_m"].toDouble() : 0;
}

Result<void> tellWhereItWent(Client &client, const Arguments &arguments, const Driver &driver) {
    const auto to = poseOf(client, arguments);
    if (!to)
        return to.error();
    const Pose2D from = driver.from().value_or(*to), moved = from.inverse() * *to;
    print(arguments,
          QJsonObject{{"seconds", driver.seconds()},
                      {"from", asJson(from)},
                      {"to", asJson(*to)},
                      {"moved", asJson(moved)}},
          QString("drove for %1 s and stands; by the odometry it went %2, and is at %3")
              .arg(driver.seconds(), 0, 'f', 1)
              .arg(text(moved), text(*to)));
    return {};
}

Result<void> driveOn(Driver &driver, double seconds) {
    const Waiting waiting(std::chrono::milliseconds(qint64(1000 * seconds)), "driving, second");
    return driver.run();
}

Result<void> driveByKeys(DriveKeys &keys, Driver &driver) {
    note(DriveKeys::help);
    Result<void> result;
    QElapsedTimer last;
    const auto stoodStill = [&last] { return last.restart() > frozen_ms; };
    {
        KeyTerminal terminal([&](const QByteArray &bytes) {
            if (stoodStill() && !bytes.isEmpty()) // when the keys were pressed nobody knows
                return terminal.forget();
            const auto action = bytes.isEmpty() ? DriveKeys::Action::Quit : keys.take(bytes, monotonicNow());
            if (action == DriveKeys::Action::Stop)
                driver.brake();
            if (action != DriveKeys::Action::Quit)
                return;
            terminal.end();
            driver.end();
        });
        last.start();
        QTimer timer;
        QObject::connect(&timer, &QTimer::timeout, &timer, [&] {
            if (stoodStill())
                terminal.forget();
        });
        timer.start(beat);
        result = driver.run();
    }
    if (isTerminal(StandardStream::Errors))
        std::fputc('\n', stderr);
    return result;
}

/// On stderr, over itself.
void show(const Twist2D &request) {
    if (isTerminal(StandardStream::Errors) && takesMore(stderr))
        std::fprintf(stderr, "\rvx %5.2f m/s, omega %5.2f rad/s ", request.vx, request.omega);
}

/// Whoever began this has gone: the program that reads what it prints, the connection by ssh, the terminal.
class Company {
public:
    bool isGone() const {
        return readerIsGone() || isOtherEndGone(stderr) || (hadInput_ && isOtherEndGone(stdin));
    }

private:
    const bool hadInput_ = !isOtherEndGone(stdin);
};

/// What the command line says after the daemon; absent: no velocity, keys drive. Error: an unknown name, one
/// that is there twice, or no finite number.
Result<std::optional<Twist2D>> velocityOf(const Arguments &arguments) {
    const QStringList words = arguments.words.mid(1);
    std::array<std::optional<double>, 3> values;
    for (const QString &word : words) {
        const QString name = word.section('=', 0, 0), text = word.section('=', 1);
        const int place = velocityNames().indexOf(name);
        if (place < 0)
            return Error(ErrorCode::InvalidParams,
                         QString("\"%1\": there is no velocity %2, expected vx, vy or omega%3")
                             .arg(word, name, didYouMean(name, velocityNames())));
        if (values.at(std::size_t(place)))
            return Error(ErrorCode::InvalidParams, QString("%1 is there twice").arg(name));
        bool ok = false;
        const double value = text.toDouble(&ok);
        if (!ok || !std::isfinite(value))
            return Error(ErrorCode::InvalidParams,
                         QString("%1 is \"%2\", expected a number of %3")
                             .arg(name, text, name == "omega" ? QString("rad/s") : QString("m/s")));
        values.at(std::size_t(place)) = value;
    }
    if (words.isEmpty())
        return std::optional<Twist2D>();
    return std::optional<Twist2D>({values[0].value_or(0), values[1].value_or(0), values[2].value_or(0)});
}

} // namespace

const QStringList &velocityNames() {
    static const QStringList names{"vx", "vy", "omega"};
    return names;
}

Result<void> checkDrive(const Arguments &arguments) {
    const auto velocity = velocityOf(arguments);
    if (!velocity)
        return velocity.error();
    if (!*velocity && !isTerminal(StandardStream::Input))
        return Error(ErrorCode::InvalidParams,
                     "drive needs a velocity (vx=, vy= in m/s, omega= in rad/s), or a terminal for keys");
    if (*velocity && arguments.for_s <= 0 && !qEnvironmentVariableIsEmpty("SSH_CONNECTION"))
        return Error(ErrorCode::InvalidParams,
                     "over ssh a drive with a velocity needs --for S: if the network fails, the robot drives "
                     "on until then; by keys it stops at once");
    return {};
}

Result<void> drive(Client &client, const Arguments &arguments) {
    if (const auto ready = waitUntilReady(client, arguments); !ready)
        return ready;
    const std::optional<Twist2D> velocity = *velocityOf(arguments);
    const double radius = leastRadiusOf(client, arguments);
    DriveKeys keys(radius > 0);
    Driver driver(client, arguments, "motor.drive", [&] {
        Twist2D request = velocity ? *velocity : keys.request(monotonicNow());
        if (const double most = std::abs(request.vx) / radius; !velocity && radius > 0)
            request.omega = std::clamp(request.omega, -most, most);
        if (!velocity)
            show(request);
        return asJson(request).toObject();
    });
    const double seconds = velocity && arguments.for_s <= 0 ? usualDrive_s : arguments.for_s;
    driver.endAfter(seconds);
    SignalWatcher signals(nullptr);
    QObject::connect(&signals, &SignalWatcher::received, &client, [&driver] { driver.end(); });
    QTimer look;
    QObject::connect(&look, &QTimer::timeout, &client, [&driver, company = Company()] {
        if (company.isGone())
            driver.end();
    });
    look.start(beat);
    const auto driven = velocity ? driveOn(driver, seconds) : driveByKeys(keys, driver);
    if (!driven)
        return driven;
    return tellWhereItWent(client, arguments, driver);
}

} // namespace hermes::ctl
