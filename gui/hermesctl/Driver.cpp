#include "gui/hermesctl/Driver.h"

#include "common/Time.h"
#include "gui/hermesctl/Waiting.h"
#include "protocol/wire/Fields.h"

#include <QHostInfo>
#include <QPointer>
#include <QTimer>
#include <utility>

namespace hermes::ctl {
namespace {

constexpr std::chrono::milliseconds period{50}; // of the commands
constexpr double lease_s = 1;                   // of the control, without a command
constexpr double standing_s = 5;                // after a stop
constexpr double unheard_s = 0.5;               // in a shorter drive no answer need have come

double secondsOf(const QElapsedTimer &timer) {
    return double(timer.elapsed()) / 1000;
}

} // namespace

Result<void> Driver::run() {
    if (const auto acquired = acquire(); !acquired)
        return acquired;
    QObject::connect(&client_, &Client::disconnected, &loop_,
                     [this](const QString &reason) { fail(Error(ErrorCode::Disconnected, reason)); });
    const int odometry = client_.subscribe("odometry", {{"queue", 1}},
                                           [this](const TopicUpdate &update) { onOdometry(update); });
    QTimer timer;
    timer.setTimerType(Qt::PreciseTimer);
    QObject::connect(&timer, &QTimer::timeout, &loop_, [this] { tick(); });
    timer.start(period);
    begun_.start();
    if (!hasEnded_)
        loop_.exec();
    timer.stop();
    seconds_ = isDriving_ ? secondsOf(driving_) : 0;
    client_.unsubscribe(odometry);
    QObject::disconnect(&client_, nullptr, &loop_, nullptr);
    return stop();
}

void Driver::end() {
    hasEnded_ = true;
    loop_.quit();
}

void Driver::brake() {
    client_.call(
        "motor.stop", QJsonObject(), [](const auto &) {}, arguments_.timeout, Client::Repeats::AtOnce);
}

Result<void> Driver::acquire() {
    const double asked = monotonicNow();
    const auto state = ask(client_, arguments_, "motor.state");
    latency_s_ = monotonicNow() - asked;
    if (!state)
        return state.error();
    const auto acquired =
        ask(client_, arguments_, "control.acquire",
            QJsonObject{{"client", "hermesctl on " + QHostInfo::localHostName()}, {"timeout_s", lease_s}});
    return acquired ? Result<void>() : acquired.error();
}

void Driver::onOdometry(const TopicUpdate &update) {
    if (update.replayed)
        return;
    ReadReport report;
    const auto odometry = readMessage<OdometryMessage>(update.data, report);
    if (!odometry)
        return fail(Error(ErrorCode::InternalError, "odometry: " + report.text()));
    clock_.add(update.stamp, stampNow(), latency_s_);
    if (!from_)
        from_ = odometry->pose;
}

void Driver::tick() {
    if (!from_) { // without it nothing is known of the robot's clock
        if (begun_.hasExpired(arguments_.timeout.count()))
            fail(Error(
                ErrorCode::TimedOut,
                QString("no odometry came within %1 s").arg(double(arguments_.timeout.count()) / 1000)));
        return;
    }
    if (isDriving_ && most_s_ > 0 && secondsOf(driving_) >= most_s_)
        return end();
    if (!std::exchange(isDriving_, true))
        driving_.start();
    send();
}

void Driver::send() {
    ++sent_;
    QJsonObject command = request_();
    command["stamp"] = stampNow() + clock_.seconds();
    client_.call(
        method_, command,
        [this, guard = QPointer<QEventLoop>(&loop_)](const Result<QJsonValue> &result) {
            if (guard && result)
                ++obeyed_;
            else if (guard)
                onRefused(result.error());
        },
        arguments_.timeout, Client::Repeats::None); // a late one would move the robot
}

void Driver::onRefused(const Error &error) {
    const bool isLate = error.is(ErrorCode::NotReady) && error.data.isUndefined();
    if (!isLate && !hasEnded_) // the next may come in time; where none does, the control ends
        fail(error);
}

void Driver::fail(Error error) {
    if (error.is(ErrorCode::Disconnected)) // says the connection, or a command on its way
        error.message += "; the motor control stops a robot whose driver has gone; if it has ended itself, "
                         "the controllers stop by their own time-out";
    if (failure_)
        failure_ = error;
    end();
}

Result<void> Driver::stop() {
    if (!client_.isConnected())
        return failure_;
    if (!failure_ && failure_.error().is(ErrorCode::ControlHeld) && !client_.isLossy())
        client_.call("motor.state", QJsonObject(),
                     [this, guard = QPointer<QEventLoop>(&loop_)](const Result<QJsonValue> &state) {
                         if (guard && state)
                             halted_ = (*state)["halted"].toString();
                     });
    const auto stopped = client_.callAndWait("motor.stop", QJsonObject{{"wait_s", standing_s}},
                                             arguments_.timeout + std::chrono::seconds(int(standing_s)),
                                             Client::Repeats::AtOnce);
    (void)ask(client_, arguments_, "control.release");
    if (!failure_) {
        Error error = failure_.error();
        if (!halted_.isEmpty())
            error.message += "; the robot had stopped: " + halted_;
        return error;
    }
    if (!stopped)
        return stopped.error();
    if (obeyed_ == 0 && seconds_ > unheard_s)
        return Error(
            ErrorCode::NotReady,
            QString("the robot obeyed none of %1 commands: they came too late, or no answer came. The clocks "
                    "may disagree, or the connection is slower than safety.command_timeout_s")
                .arg(sent_));
    if (!(*stopped)["confirmed"].toBool())
        return Error(ErrorCode::DeviceFault,
                     "the robot was told to stop, but does not confirm that it stands: " +
                         (*stopped)["text"].toString());
    return {};
}

Result<void> waitUntilReady(Client &client, const Arguments &arguments) {
    const Waiting told(arguments.timeout);
    QElapsedTimer waiting;
    waiting.start();
    while (true) {
        const auto state = ask(client, arguments, "motor.state");
        if (!state)
            return state.error();
        if ((*state)["ready"].toBool() || waiting.hasExpired(arguments.timeout.count()))
            return {}; // the first command is refused, and the refusal says why
        QEventLoop pause;
        QTimer::singleShot(100, &pause, &QEventLoop::quit);
        pause.exec();
    }
}

} // namespace hermes::ctl
