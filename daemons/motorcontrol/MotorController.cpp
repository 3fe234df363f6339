#include "daemons/motorcontrol/MotorController.h"

#include "daemons/motorcontrol/FailureText.h"
#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hermes::motorcontrol {

using drive::Bus;
using drive::Command;
using Kind = Command::Kind;

namespace {

constexpr double setupTimeout_s = 0.25; // a set-up waits for slow adapters, to tell how slow they are
constexpr double standMargin_s = 0.2;   // and half of the time of braking more: motors lag behind
constexpr double longestStep_s = 0.04; // a cycle that came later: this program stood still, and asked nothing

constexpr std::array<qint32, 2> zero{};

QString placeOf(const ControllerAddress &place) {
    const DeviceModel::Address &address = place.model->address;
    return address.text ? QString(address.text).arg(place.address, 0, address.base) + " on " + place.url
                        : place.url;
}

} // namespace

MotorController::MotorController(int number, const ControllerAddress &address, int onLine)
    : place_(address)
    , name_(QString("controller %1 (%2)").arg(number).arg(placeOf(address)))
    , onLine_(onLine)
    , device_(address.model->make(address.address))
    , timeoutAtMost_s_(device_->timeout().atMost_s) {}

void MotorController::configure(const MotorSettings &settings) {
    const double countsPerRadian = settings.countsPerTurn / (2 * vectorlib::pi);
    deceleration_ = std::max(
        1u, quint32(std::llround(settings.emergencyDeceleration / settings.wheelRadius * countsPerRadian)));
    watch_.setThreshold(settings.encoder.moving * countsPerRadian);
    disobeyAfter_s_ = settings.encoder.hold_s;
    fullSpeed_ = settings.pid.qpps;
    promised_s_ = settings.serialTimeout_s;
    mayLackTimeout_ = settings.mayLackTimeout;
    if (!device_->configure(settings.device()) && keepsPromise())
        return;
    timeoutAtMost_s_ = std::max(timeoutAtMost_s_, device_->timeout().silence_s());
    if (state_ != State::Stopping)
        lose("is being set up with new settings");
}

void MotorController::lineClosed(const QString &reason) {
    heard_ = timeoutKnown_ = false;
    device_->forgetLine();
    lose(reason);
    silentUntil_ = nextSetup_ = 0;
}

void MotorController::bar(const QString &reason) {
    if (std::exchange(barred_, true))
        return;
    barReason_ = reason;
    lose(reason);
}

void MotorController::release() {
    if (!std::exchange(barred_, false))
        return;
    const bool wasTold = isToldToStand();
    lose("was released, and has to stand before it is set up");
    if (wasTold) // no new stop shortens the silence in which it stops by itself
        stopStep_ = nextAttempt();
    silentUntil_ = setPointSent_ + silence_s();
}

void MotorController::lose(const QString &reason) {
    if (isReady() && !watch_.stands()) { // it may not have heard the zero that was sent last
        brakesUntil_ = std::max(brakesUntil_, awake_ + rampTime());
        turnsUntil_ = brakesUntil_ + std::max(silence_s(), device_->timeout().seconds);
    }
    state_ = State::Stopping;
    error_ = reason;
    stopStep_ = StopStep::Tell;
    nextStop_ = brakeUntil_ = 0;
    watch_.doubt();
    rate_.restart();
    readings_.countsTime = 0;
    readings_.complete = false;
    asked_.reset();
    wantsEncoders_ = wantsSlow_ = false;
}

double MotorController::silence_s() const {
    return timeoutAtMost_s_ + timeoutMargin_s;
}

double MotorController::brakingTime() const {
    const double speed = std::min(watch_.speed(), overspeed * fullSpeed_); // counts may jump
    return standMargin_s + watch_.window_s() + 1.5 * speed / deceleration_;
}

double MotorController::rampTime() const {
    return double(std::max(std::abs(speeds_[0]), std::abs(speeds_[1]))) / deceleration_;
}

void MotorController::command(const std::array<qint32, 2> &speeds, std::optional<double> servo) {
    if (!isReady())
        return;
    if (speeds != zero)
        watch_.doubt();
    else if (speeds_ != zero)
        brakesUntil_ = awake_ + rampTime(),
        standBy_ = clock_ + brakingTime() + 3 / rate_Hz().value_or(1 / longestStep_s);
    speeds_ = speeds;
    servo_ = servo;
    ++commanded_;
}

void MotorController::beginCycle(double now) {
    const double step = std::clamp(now - std::exchange(lastCycle_, now), 0.0, longestStep_s);
    awake_ += step;
    if (!lineHeld_ || isFailing())
        clock_ += step;
    if (isReady())
        watchAnswers();
    if (isReady())
        watchStandstill();
    if (!isReady())
        return;
    overruns_ += wantsEncoders_;
    wantsEncoders_ = true;
    wantsSlow_ = device_->slowReadings() > 0;
}

void MotorController::watchAnswers() {
    if (clock_ - lastAnswer_ > lostAfter_s)
        heard_ = false;
    if (clock_ - lastObeyed_ > lostAfter_s)
        lose(failureOf({Kind::SetSpeeds}));
    else if (clock_ - lastCounts_ > lostAfter_s)
        lose(failureOf({Kind::ReadEncoders}));
    else if (device_->slowReadings() > 0 && clock_ - lastSlow_ > slowLostAfter_s)
        lose(failureOf({Kind::ReadSlow, slow_}));
}

void MotorController::watchStandstill() {
    if (speeds_ != zero)
        return;
    if (watch_.stands())
        standBy_ = clock_ + disobeyAfter_s_ + timeoutMargin_s; // a push is no disobedience
    if (clock_ <= standBy_)
        return;
    disobedience_ =
        "was told to stop and kept turning; its line is silent now, so that it stops by its own time-out";
    bar("was told to stop and kept turning");
}

bool MotorController::isToStop() const {
    if (state_ == State::Stopping)
        return !isToldToStand();
    return isReady() && toldToTurn_ && speeds_ == zero;
}

MotorController::Ask MotorController::ask(const Command &command, double timeout_s) const {
    return {command, {&device_->reader(), device_->bytes(command), address()}, timeout_s};
}

QString MotorController::failureOf(const Command &command) const {
    return failureText(device_->nameOf(command), failure_, heard_);
}

std::optional<MotorController::Ask> MotorController::next(Task task, double now) {
    const auto asked = due(task, now);
    if (!asked)
        return asked;
    asked_ = asked->command;
    if (asked_->kind == Kind::SetSpeeds || asked_->kind == Kind::CutPower) {
        sent_ = commanded_;
        toldToTurn_ = isReady() && speeds_ != zero;
        setPointSent_ = now;
        isFirstStop_ = !isToldToStand();
        stopStep_ = nextAttempt();
        if (toldToTurn_) // what it acknowledged before does not count
            watch_.doubt();
    }
    return asked;
}

std::optional<MotorController::Ask> MotorController::due(Task task, double now) const {
    switch (state_) {
    case State::Stopping:
        return dueStop(task, now);
    case State::SetUp:
        if (task != Task::Background)
            return std::nullopt;
        return ask({Kind::SetUp, setupStep_}, setupTimeout_s);
    case State::Ready:
        break;
    }
    return dueReady(task);
}

std::optional<MotorController::Ask> MotorController::dueStop(Task task, double now) const {
    if (task != (isToldToStand() ? Task::Background : Task::SetPoint) || now < nextStop_)
        return std::nullopt;
    switch (stopStep_) {
    case StopStep::Tell: // with the ramp, and not waiting for long
        return ask(barred_ ? Command{Kind::CutPower} : Command{Kind::SetSpeeds, 0, zero, deceleration_},
                   shortestReplyTimeout_s);
    case StopStep::SetTimeout:
        return ask({Kind::SetTimeout}, shortestReplyTimeout_s);
    case StopStep::CutPower:
        return ask({Kind::CutPower}, silence_s());
    case StopStep::Look:
        return ask({Kind::ReadEncoders}, silence_s());
    }
    return std::nullopt;
}

std::optional<MotorController::Ask> MotorController::dueReady(Task task) const {
    switch (task) {
    case Task::SetPoint:
        if (obeyed_ != commanded_)
            return ask({Kind::SetSpeeds, 0, speeds_, deceleration_, servo_}, replyTimeout_s_);
        break;
    case Task::Encoders:
        if (wantsEncoders_)
            return ask({Kind::ReadEncoders}, replyTimeout_s_);
        break;
    case Task::Background:
        if (wantsSlow_)
            return ask({Kind::ReadSlow, slow_}, replyTimeout_s_);
        break;
    }
    return std::nullopt;
}

} // namespace hermes::motorcontrol
