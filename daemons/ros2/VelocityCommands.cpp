#include "daemons/ros2/VelocityCommands.h"

#include "common/Log.h"
#include "common/Time.h"
#include "protocol/wire/Fields.h"

#include <cmath>

namespace hermes::ros2 {
namespace {

// Without a command for so long the control ends; the robot stops before. Longer than a pause, so that a
// command within it is none of somebody who has lost the control.
constexpr double lease_s = VelocityCommands::pause_s + 0.2;
constexpr std::size_t maxWriters = 100; // whose clocks are known
constexpr double afterGap_s = 0.1; // what comes so soon after this program stood still was sent while it did
constexpr std::chrono::milliseconds timeout{500};

QJsonObject paramsOf(const Twist2D &velocity, double stamp) {
    return {{"vx", velocity.vx}, {"vy", velocity.vy}, {"omega", velocity.omega}, {"stamp", stamp}};
}

/// One command was void; other errors mean that the control is lost, or the robot may not move.
bool isOnlyLate(const Error &error) {
    return error.is(ErrorCode::TimedOut) || (error.is(ErrorCode::NotReady) && error.data.isUndefined());
}

} // namespace

Client *motorControl(const RobotDaemons &daemons) {
    for (const auto &[address, daemon] : daemons.all())
        if (daemon->isKnown && daemon->commands.contains("motor.drive"))
            return daemon->client.get();
    return nullptr;
}

void VelocityCommands::take(const Twist2D &velocity, const Guid &writer, double written_s, double age_s,
                            const QString &node) {
    const double late_s = age_s + delayOf(writer, written_s);
    if (!(std::abs(late_s) <= maxAge_s) ||
        !(std::isfinite(velocity.vx) && std::isfinite(velocity.vy) && std::isfinite(velocity.omega))) {
        ++counts_.late;
        return;
    }
    const double now = monotonicNow();
    const bool hasPaused = now - last_ > pause_s;
    if (writer != writer_ && !hasPaused) {
        ++counts_.others;
        return;
    }
    writer_ = writer;
    last_ = now;
    node_ = node;
    ++counts_.taken;
    newest_ = {velocity, stampNow() - std::max(0.0, late_s)};
    if (hasPaused) {
        state_ = State::Idle; // the lease has ended meanwhile
        refusal_.clear();
    }
    if (state_ == State::Idle)
        acquire();
    else if (state_ == State::Driving)
        drive(newest_);
    else if (state_ == State::Refused)
        ++counts_.refused;
}

/// How long it was on the way. The clocks of two hosts differ: the fastest commands tell by how much.
double VelocityCommands::delayOf(const Guid &writer, double written_s) {
    gaps_.look();
    if (gaps_.sinceLast() < afterGap_s)
        return std::numeric_limits<double>::infinity(); // it was sent while this program stood still
    if (clocks_.size() >= maxWriters && clocks_.count(writer) == 0)
        clocks_.clear();
    ClockOffset &clock = clocks_[writer];
    const double now = stampNow();
    clock.add(written_s, now, 0);
    return std::max(0.0, now + clock.seconds() - written_s);
}

void VelocityCommands::acquire() {
    Client *const client = motorControl(daemons_);
    if (!client)
        return refuse("no motor control answers");
    state_ = State::Acquiring;
    const QJsonObject params{{"client", node_.left(100)}, {"timeout_s", lease_s}};
    const auto answered = [this](const Result<QJsonValue> &result) {
        if (state_ != State::Acquiring)
            return;
        if (!result)
            return refuse(result.error().message);
        state_ = State::Driving;
        drive(newest_); // whose stamp tells when it is too old
    };
    client->call("control.acquire", params, answered, timeout, Client::Repeats::None);
}

void VelocityCommands::drive(const Command &command) {
    Client *const client = motorControl(daemons_);
    if (!client)
        return refuse("no motor control answers");
    client->call(
        "motor.drive", paramsOf(command.velocity, command.stamp),
        [this](const Result<QJsonValue> &result) {
            if (!result && state_ == State::Driving && !isOnlyLate(result.error()))
                refuse(result.error().message);
        },
        timeout, Client::Repeats::None);
}

void VelocityCommands::refuse(const QString &why) {
    ++counts_.refused;
    state_ = State::Refused;
    if (refusal_.isEmpty())
        logWarning("cmd_vel", QString("%1 does not move the robot: %2").arg(node_, why));
    refusal_ = why;
}

} // namespace hermes::ros2
