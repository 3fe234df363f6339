#include "gui/setup/WheelTurn.h"

#include "common/Time.h"

#include <QPointer>
#include <utility>

namespace hermes {
namespace {

constexpr std::chrono::milliseconds period{50};    // of the commands
constexpr std::chrono::milliseconds look{100};     // whether the controllers are found
constexpr double lease_s = 1;                      // of the control, without a command
constexpr double standing_s = 5;                   // after a stop
constexpr std::chrono::milliseconds longest{3000}; // of the commands, where no reading comes
constexpr double settled_s = 0.5;                  // then it has the speed that was asked for
constexpr double leastSpan_s = 0.1;                // of the readings

} // namespace

WheelTurn::WheelTurn(Client &motors, QString holder, std::chrono::milliseconds timeout, QObject *parent)
    : QObject(parent)
    , motors_(motors)
    , holder_(std::move(holder))
    , timeout_(timeout) {
    timer_.setTimerType(Qt::PreciseTimer);
    connect(&timer_, &QTimer::timeout, this, &WheelTurn::tick);
    connect(&motors, &Client::disconnected, this, [this](const QString &reason) {
        if (isHolding_)
            fail(Error(ErrorCode::Disconnected,
                       reason + "; the motor control stops a robot whose driver has gone; if it has ended "
                                "itself, the controllers stop by their own time-out"));
    });
}

void WheelTurn::begin(const QString &wheel, double speed, const Done &done) {
    wheel_ = wheel;
    speed_ = speed;
    done_ = done;
    phase_ = Phase::Preparing;
    failure_ = {};
    begin_.reset();
    first_.reset();
    turning_.invalidate();
    waiting_.start();
    awaitReady();
}

void WheelTurn::giveUp() {
    fail(Error(ErrorCode::NotReady, "the test of the wheels was given up"));
}

void WheelTurn::call(const QString &method, const QJsonObject &params, const Client::Callback &answered,
                     std::chrono::milliseconds timeout, Client::Repeats repeats) {
    const auto guarded = [answered, guard = QPointer<WheelTurn>(this)](const auto &result) {
        if (guard)
            answered(result);
    };
    motors_.call(method, params, guarded, timeout, repeats);
}

void WheelTurn::awaitReady() {
    if (phase_ != Phase::Preparing)
        return;
    const bool isLate = waiting_.hasExpired(timeout_.count());
    const auto again = [this] { QTimer::singleShot(look, this, &WheelTurn::awaitReady); };
    if (!motors_.isConnected())
        return isLate ? fail(Error(ErrorCode::Disconnected, motors_.problem())) : again();
    const double asked = monotonicNow();
    call(
        "motor.state", {},
        [=](const Result<QJsonValue> &state) {
            if (phase_ != Phase::Preparing)
                return;
            if (!state)
                return fail(state.error());
            latency_s_ = monotonicNow() - asked;
            if ((*state)["ready"].toBool() || isLate)
                acquire(); // where it is not ready the first command is refused, and the refusal says why
            else
                again();
        },
        timeout_);
}

void WheelTurn::acquire() {
    const auto acquired = [this](const Result<QJsonValue> &result) {
        isAcquiring_ = false;
        isHolding_ = result.ok();
        if (phase_ == Phase::Stopping) // given up meanwhile
            return isHolding_ ? release() : finish();
        if (!result)
            return fail(result.error());
        phase_ = Phase::Turning;
        isClockKnown_ = false;
        waiting_.start();
        odometry_ = motors_.subscribe("odometry", {{"queue", 1}},
                                      [this](const TopicUpdate &update) { onOdometry(update); });
        wheels_ = motors_.subscribe("wheels", {{"queue", 100}},
                                    [this](const TopicUpdate &update) { onWheels(update); });
        timer_.start(period);
    };
    isAcquiring_ = true;
    call("control.acquire", {{"client", holder_}, {"timeout_s", lease_s}}, acquired, timeout_);
}

void WheelTurn::onOdometry(const TopicUpdate &update) {
    if (update.replayed)
        return;
    clock_.add(update.stamp, stampNow(), latency_s_);
    isClockKnown_ = true;
}

void WheelTurn::onWheels(const TopicUpdate &update) {
    if (update.replayed)
        return;
    const QJsonValue wheel = update.json()[wheel_];
    if (!begin_ && wheel["set_point"].toDouble() == 0)
        return;
    begin_ = begin_.value_or(update.stamp);
    if (update.stamp - *begin_ < settled_s)
        return;
    last_ = {update.stamp, wheel["angle"].toDouble()};
    if (!first_)
        first_ = last_;
}

void WheelTurn::tick() {
    if (!isClockKnown_) { // a command without the robot's time is refused where the clocks differ
        if (waiting_.hasExpired(timeout_.count()))
            fail(Error(ErrorCode::TimedOut,
                       QString("no odometry came within %1 s").arg(double(timeout_.count()) / 1000)));
        return;
    }
    if (!turning_.isValid())
        turning_.start();
    if (measured_s() >= turn_s - settled_s || turning_.hasExpired(longest.count()))
        return stop();
    call(
        "motor.wheels", {{wheel_, speed_}, {"stamp", stampNow() + clock_.seconds()}},
        [this](const Result<QJsonValue> &result) {
            const bool isLate =
                !result && result.error().is(ErrorCode::NotReady) && result.error().data.isUndefined();
            if (result || isLate || phase_ != Phase::Turning)
                return; // after a late one the next may be in time
            const Error &why = result.error();
            fail(Error(ErrorCode::DeviceFault,
                       wheel_ + ": " + why.message +
                           (why.data["encoder"].isUndefined()
                                ? ""
                                : "; swap the wires A and B of its encoder, or connect it")));
        },
        timeout_, Client::Repeats::None); // a late one would move the robot
}

void WheelTurn::fail(const Error &error) {
    if (phase_ == Phase::Standing)
        return;
    if (failure_)
        failure_ = error;
    if (phase_ != Phase::Stopping)
        stop();
}

void WheelTurn::stop() {
    const bool wasTurning = phase_ == Phase::Turning;
    phase_ = Phase::Stopping;
    timer_.stop();
    if (wasTurning) {
        motors_.unsubscribe(odometry_);
        motors_.unsubscribe(wheels_);
    }
    if (isAcquiring_)
        return; // its answer gives the control back
    if (!wasTurning || !motors_.isConnected())
        return finish();
    const auto stopped = [this](const Result<QJsonValue> &result) {
        if (failure_ && !result)
            failure_ = result.error();
        else if (failure_ && !(*result)["confirmed"].toBool())
            failure_ = Error(ErrorCode::DeviceFault,
                             "the robot was told to stop, but does not confirm that it stands: " +
                                 (*result)["text"].toString());
        release();
    };
    call("motor.stop", {{"wait_s", standing_s}}, stopped, timeout_ + std::chrono::seconds(int(standing_s)),
         Client::Repeats::AtOnce);
}

void WheelTurn::release() {
    call(
        "control.release", {}, [this](const auto &) { finish(); }, timeout_);
}

Result<double> WheelTurn::measured() const {
    if (!failure_)
        return failure_.error();
    if (measured_s() < leastSpan_s)
        return Error(ErrorCode::TimedOut,
                     QString("%1: too few readings of its encoder came while it turned").arg(wheel_));
    return (last_.angle - first_->angle) / measured_s();
}

void WheelTurn::finish() {
    phase_ = Phase::Standing;
    isHolding_ = false;
    const Done done = std::exchange(done_, nullptr);
    done(measured());
}

} // namespace hermes
