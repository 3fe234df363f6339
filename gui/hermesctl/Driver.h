#pragma once

#include "common/client/ClockOffset.h"
#include "gui/hermesctl/Commands.h"
#include "protocol/messages/Motion.h"

#include <QElapsedTimer>
#include <QEventLoop>
#include <functional>
#include <optional>

namespace hermes::ctl {

/// Takes the control of a robot, sends motion commands with their time at the rate that its watchdog needs,
/// and stops; what they say it asks each time.
class Driver {
public:
    using Request = std::function<QJsonObject()>;

    /// method: of the motion command; request: its parameters but for the time.
    Driver(Client &client, const Arguments &arguments, QString method, Request request)
        : client_(client)
        , arguments_(arguments)
        , method_(std::move(method))
        , request_(std::move(request)) {}

    /// Until the time is over, end() is called, the connection is lost, or a command is refused; the robot
    /// stands then. Error: why it ended early, or that the robot has not confirmed that it stands.
    Result<void> run();
    void endAfter(double seconds) { most_s_ = seconds; } ///< 0: never
    void end();
    /// The robot brakes as in an emergency; the control stays here.
    void brake();

    double seconds() const { return seconds_; }
    /// Where the odometry was at first.
    const std::optional<Pose2D> &from() const { return from_; }

private:
    Result<void> acquire();
    void onOdometry(const TopicUpdate &update);
    void tick();
    void send();
    void onRefused(const Error &error);
    void fail(Error error);
    Result<void> stop();

    Client &client_;
    const Arguments &arguments_;
    const QString method_;
    const Request request_;
    double most_s_ = 0;
    QEventLoop loop_;
    QElapsedTimer begun_, driving_;
    ClockOffset clock_;
    double latency_s_ = 0;
    std::optional<Pose2D> from_;
    bool isDriving_ = false, hasEnded_ = false;
    double seconds_ = 0;
    Result<void> failure_;
    quint64 sent_ = 0, obeyed_ = 0;
    QString halted_; ///< why the robot had stopped before that
};

/// Waits for the controllers, which may be found a moment after the daemon has begun; not longer than the
/// time-out. Error: no answer.
Result<void> waitUntilReady(Client &client, const Arguments &arguments);

} // namespace hermes::ctl
