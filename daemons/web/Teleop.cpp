#include "daemons/web/Teleop.h"

#include "common/Time.h"
#include "common/client/DaemonAddress.h"

namespace hermes::web {
namespace {

constexpr std::chrono::milliseconds commandPeriod{50};
constexpr double longestPause_s = 0.25; // between two commands; after it the robot has stopped
constexpr double lease_s = 1; // of the control without a command, and the longest time without an answer

bool isZero(const Twist2D &twist) {
    return twist.vx == 0 && twist.vy == 0 && twist.omega == 0;
}

} // namespace

Teleop::Teleop(const QString &address, const QString &name, double deadMan_s, Tell tell)
    : address_(address)
    , name_(name)
    , deadMan_s_(deadMan_s)
    , tell_(std::move(tell)) {
    timer_.setTimerType(Qt::PreciseTimer);
    connect(&timer_, &QTimer::timeout, this, &Teleop::tick);
    connect(&client_, &Client::connected, this, [this] {
        if (state_ == State::Asking)
            acquire();
    });
    connect(&client_, &Client::disconnected, this, [this](const QString &reason) {
        if (state_ != State::Idle)
            halt(reason); // the motor control stops the robot
    });
    client_.subscribe("odometry", {{"queue", 1}, {"max_rate_hz", 10}}, [this](const TopicUpdate &update) {
        if (update.replayed)
            return;
        clock_.add(update.stamp, stampNow(), 0);
        hasClock_ = true;
    });
    if (!address_.isEmpty())
        client_.connectTo(asOwner(address_));
}

Teleop::~Teleop() {
    client_.disconnect(this);
    end();
    client_.close();
}

void Teleop::steer(const Twist2D &wish) {
    const double now = monotonicNow(), before = std::exchange(wished_, now);
    wish_ = wish;
    if (mustRest_ && now - before <= deadMan_s_ && !isZero(wish))
        return;
    mustRest_ = false;
    if (state_ != State::Idle || isZero(wish))
        return;
    if (address_.isEmpty())
        return halt("no daemon is there that drives");
    state_ = State::Asking;
    timer_.start(commandPeriod);
    if (client_.isConnected())
        acquire();
}

void Teleop::acquire() {
    client_.call("control.acquire", QJsonObject{{"client", name_}, {"timeout_s", lease_s}},
                 [this, alive = QPointer<Teleop>(this)](const Result<QJsonValue> &result) {
                     if (!alive || state_ != State::Asking)
                         return;
                     if (!result)
                         return halt(result.error().message);
                     state_ = State::Driving;
                     answered_ = ticked_ = monotonicNow();
                     tick();
                 });
}

void Teleop::tick() {
    const double now = monotonicNow();
    if (now - wished_ > deadMan_s_)
        return state_ == State::Asking ? halt("the motor control does not answer") : end();
    if (state_ != State::Driving)
        return;
    if (now - std::exchange(ticked_, now) > longestPause_s)
        return halt("hermes-web stood still");
    if (now - answered_ > lease_s)
        return halt("the motor control does not answer");
    QJsonObject command{{"vx", wish_.vx}, {"vy", wish_.vy}, {"omega", wish_.omega}};
    if (hasClock_)
        command["stamp"] = stampNow() + clock_.seconds();
    client_.call(
        "motor.drive", command,
        [this, alive = QPointer<Teleop>(this)](const Result<QJsonValue> &result) {
            if (alive && state_ == State::Driving)
                onAnswer(result);
        },
        Client::defaultTimeout, Client::Repeats::None); // a late one would move the robot
}

void Teleop::onAnswer(const Result<QJsonValue> &result) {
    answered_ = monotonicNow();
    const bool isLate =
        !result && result.error().is(ErrorCode::NotReady) && result.error().data.isUndefined();
    if (!result && !isLate)
        halt(result.error().message);
}

void Teleop::end() {
    timer_.stop();
    if (std::exchange(state_, State::Idle) == State::Idle)
        return;
    client_.call(
        "motor.stop", QJsonObject{{"client", name_}}, [](const auto &) {}, Client::defaultTimeout,
        Client::Repeats::AtOnce);
    client_.call("control.release", QJsonObject(), [](const auto &) {});
}

/// By somebody else's word: a stop from here would be one of their drive.
void Teleop::halt(const QString &why) {
    timer_.stop();
    mustRest_ = true;
    if (std::exchange(state_, State::Idle) == State::Driving)
        client_.call("control.release", QJsonObject(), [](const auto &) {});
    tell_(why);
}

} // namespace hermes::web
