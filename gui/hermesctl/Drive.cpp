// hermesctl drive: the robot moves as long as this runs.
#include "common/Time.h"
#include "common/client/ClockOffset.h"
#include "common/daemon/SignalWatcher.h"
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/DriveKeys.h"
#include "gui/hermesctl/DriveLine.h"
#include "protocol/wire/Fields.h"

#include <QElapsedTimer>
#include <QEventLoop>
#include <QHostInfo>
#include <QPointer>
#include <QSocketNotifier>
#include <QTimer>
#include <cmath>
#include <cstdio>
#include <unistd.h>

namespace hermes::ctl {
namespace {

constexpr std::chrono::milliseconds period{50}; // of the commands
constexpr double lease_s = 1;                   // of the control, without a command
constexpr double standing_s = 5;                // after a stop
constexpr double degree = 0.017453292519943295;

/// Takes the control, sends motion commands with their time, and stops; what they say it asks each time.
class Driver {
public:
    using Wish = std::function<Twist2D()>;

    Driver(Client &client, const Arguments &arguments, Wish wish)
        : client_(client)
        , arguments_(arguments)
        , wish_(std::move(wish)) {}

    /// Until the time is over, end() is called, the connection is lost, or a command is refused. Then the
    /// robot was told to stop.
    Result<void> run() {
        if (const auto acquired = acquire(); !acquired)
            return acquired;
        QObject::connect(&client_, &Client::disconnected, &loop_, [this](const QString &reason) {
            fail(Error(ErrorCode::Disconnected,
                       reason + "; the motor control stops a robot whose driver has gone"));
        });
        const int odometry = client_.subscribe(QStringLiteral("odometry"), {{"queue", 1}},
                                               [this](const TopicUpdate &update) { onOdometry(update); });
        QTimer timer;
        timer.setTimerType(Qt::PreciseTimer);
        QObject::connect(&timer, &QTimer::timeout, &loop_, [this] { tick(); });
        timer.start(period);
        begun_.start();
        if (!hasEnded_)
            loop_.exec();
        timer.stop();
        seconds_ = isDriving_ ? double(driving_.elapsed()) / 1000 : 0;
        client_.unsubscribe(odometry);
        QObject::disconnect(&client_, nullptr, &loop_, nullptr);
        return stop();
    }

    void end() {
        hasEnded_ = true;
        loop_.quit();
    }
    /// The robot brakes as in an emergency; the control stays here.
    void brake() {
        client_.call(
            QStringLiteral("motor.stop"), QJsonObject(), [](const auto &) {}, arguments_.timeout,
            Client::Repeats::AtOnce);
    }

    double seconds() const { return seconds_; }
    const std::optional<Pose2D> &from() const { return from_; }

private:
    Result<void> acquire() {
        const double asked = monotonicNow();
        const auto state = ask(client_, arguments_, QStringLiteral("motor.state"));
        latency_s_ = monotonicNow() - asked;
        if (!state)
            return state.error();
        const auto acquired = ask(
            client_, arguments_, QStringLiteral("control.acquire"),
            QJsonObject{{"client", "hermesctl on " + QHostInfo::localHostName()}, {"timeout_s", lease_s}});
        return acquired ? Result<void>() : acquired.error();
    }

    void onOdometry(const TopicUpdate &update) {
        ReadReport report;
        const auto odometry = readMessage<OdometryMessage>(update.data, report);
        if (!odometry)
            return fail(Error(ErrorCode::InternalError, "odometry: " + report.text()));
        clock_.add(update.stamp, stampNow(), latency_s_);
        if (!from_)
            from_ = odometry->pose;
    }

    void tick() {
        if (!from_) {
            if (begun_.hasExpired(arguments_.timeout.count()))
                fail(Error(
                    ErrorCode::TimedOut,
                    QString("no odometry came within %1 s").arg(double(arguments_.timeout.count()) / 1000)));
            return;
        }
        if (isDriving_ && arguments_.for_s > 0 && double(driving_.elapsed()) / 1000 >= arguments_.for_s)
            return end();
        if (!std::exchange(isDriving_, true))
            driving_.start();
        const Twist2D wish = wish_();
        const QJsonObject command{{"vx", wish.vx},
                                  {"vy", wish.vy},
                                  {"omega", wish.omega},
                                  {"stamp", stampNow() + clock_.seconds()}};
        client_.call(
            QStringLiteral("motor.drive"), command,
            [this, guard = QPointer<QEventLoop>(&loop_)](const Result<QJsonValue> &result) {
                if (guard && !result)
                    onRefused(result.error());
            },
            arguments_.timeout, Client::Repeats::None); // a late one would move the robot
    }

    void onRefused(const Error &error) {
        const bool isLate = error.is(ErrorCode::NotReady) && error.data.isUndefined();
        if (!isLate && !hasEnded_) // the next may come in time; where none does, the control ends
            fail(error);
    }

    void fail(const Error &error) {
        if (failure_)
            failure_ = error;
        end();
    }

    /// Error: the robot has not confirmed that it stands, or why the drive ended before.
    Result<void> stop() {
        if (!client_.isConnected())
            return failure_;
        const auto stopped = client_.callAndWait(
            QStringLiteral("motor.stop"), QJsonObject{{"wait_s", standing_s}},
            arguments_.timeout + std::chrono::seconds(int(standing_s)), Client::Repeats::AtOnce);
        (void)ask(client_, arguments_, QStringLiteral("control.release"));
        if (!failure_)
            return failure_;
        if (!stopped)
            return stopped.error();
        if (!(*stopped)["confirmed"].toBool())
            return Error(ErrorCode::DeviceFault, "the robot was told to stop, but does not confirm that it "
                                                 "stands: " +
                                                     (*stopped)["text"].toString());
        return {};
    }

    Client &client_;
    const Arguments &arguments_;
    const Wish wish_;
    QEventLoop loop_;
    QElapsedTimer begun_, driving_;
    ClockOffset clock_;
    double latency_s_ = 0;
    std::optional<Pose2D> from_;
    bool isDriving_ = false, hasEnded_ = false;
    double seconds_ = 0;
    Result<void> failure_;
};

Result<Pose2D> poseOf(Client &client, const Arguments &arguments) {
    const auto state = ask(client, arguments, QStringLiteral("motor.state"));
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

Result<void> tellWhereItWent(Client &client, const Arguments &arguments, const Driver &driver) {
    const auto to = poseOf(client, arguments);
    if (!to)
        return to.error();
    const Pose2D from = driver.from().value_or(*to), moved = from.inverse() * *to;
    if (arguments.json)
        printJson(QJsonObject{{"seconds", driver.seconds()},
                              {"from", asJson(from)},
                              {"to", asJson(*to)},
                              {"moved", asJson(moved)}});
    else
        printLine(QString("drove for %1 s and stands; by the odometry it went %2, and is at %3")
                      .arg(driver.seconds(), 0, 'f', 1)
                      .arg(text(moved), text(*to)));
    return {};
}

/// The controllers may be found a moment after the daemon has begun.
Result<void> waitReady(Client &client, const Arguments &arguments) {
    QElapsedTimer waiting;
    waiting.start();
    while (true) {
        const auto state = ask(client, arguments, QStringLiteral("motor.state"));
        if (!state)
            return state.error();
        if ((*state)["ready"].toBool() || waiting.hasExpired(arguments.timeout.count()))
            return {}; // the first command is refused, and the refusal says why
        QEventLoop pause;
        QTimer::singleShot(100, &pause, &QEventLoop::quit);
        pause.exec();
    }
}

Result<void> driveByKeys(Client &client, DriveKeys &keys, Driver &driver) {
    note(QLatin1String(DriveKeys::help));
    Result<void> result;
    {
        const KeyTerminal terminal;
        QSocketNotifier typed(STDIN_FILENO, QSocketNotifier::Read);
        QObject::connect(&typed, &QSocketNotifier::activated, &client, [&] {
            const QByteArray bytes = KeyTerminal::read();
            const auto action = bytes.isEmpty() ? DriveKeys::Action::Quit : keys.take(bytes, monotonicNow());
            if (action == DriveKeys::Action::Stop)
                driver.brake();
            if (action != DriveKeys::Action::Quit)
                return;
            typed.setEnabled(false);
            driver.end();
        });
        result = driver.run();
    }
    if (::isatty(STDERR_FILENO) != 0)
        std::fputc('\n', stderr);
    return result;
}

/// On stderr, over itself.
void show(const Twist2D &wish) {
    if (::isatty(STDERR_FILENO) != 0)
        std::fprintf(stderr, "\rvx %5.2f m/s, omega %5.2f rad/s ", wish.vx, wish.omega);
}

} // namespace

Result<void> checkDrive(const Arguments &arguments) {
    const auto velocity = velocityOf(arguments);
    if (!velocity)
        return velocity.error();
    if (!*velocity && ::isatty(STDIN_FILENO) == 0)
        return Error(ErrorCode::InvalidParams,
                     "drive needs a velocity (vx=, vy= in m/s, omega= in rad/s), or a "
                     "terminal for keys");
    return {};
}

Result<void> drive(Client &client, const Arguments &arguments) {
    if (const auto ready = waitReady(client, arguments); !ready)
        return ready;
    const std::optional<Twist2D> velocity = *velocityOf(arguments);
    DriveKeys keys;
    Driver driver(client, arguments, [&] {
        const Twist2D wish = velocity ? *velocity : keys.wish(monotonicNow());
        if (!velocity)
            show(wish);
        return wish;
    });
    SignalWatcher signals(nullptr);
    QObject::connect(&signals, &SignalWatcher::received, &client, [&driver] { driver.end(); });
    const auto driven = velocity ? driver.run() : driveByKeys(client, keys, driver);
    if (!driven)
        return driven;
    return tellWhereItWent(client, arguments, driver);
}

} // namespace hermes::ctl
