#include "daemons/motorcontrol/MotorController.h"

#include "daemons/motorcontrol/FailureText.h"
#include "protocol/drive/ArduinoDevice.h"
#include "protocol/roboclaw/Device.h"
#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hermes::motorcontrol {

using drive::Bus;
using drive::Command;
using Kind = Command::Kind;

namespace {

constexpr double setupPause_s = 0.25;           // between attempts at a controller that cannot be set up
constexpr double setupTimeout_s = 0.25;         // a set-up waits for slow adapters, to tell how slow they are
constexpr double shortestReplyTimeout_s = 0.03; // FTDI adapters hold bytes for up to 16 ms
constexpr double timeoutMargin_s = 0.1;         // of the controllers' own clock
constexpr double barredSilence_s = 5;
constexpr double readingPause_s = 0.02; // while it is seen to stand
constexpr double standMargin_s = 0.2;   // and half of the time of braking more: motors lag behind
constexpr double longestStep_s = 0.04; // a cycle that came later: this program stood still, and asked nothing

constexpr double dutyPause_s = 10; // a request that is not answered holds up a stop on its line

constexpr double rounding_s = 1e-6;

constexpr std::array<qint32, 2> zero{};

std::unique_ptr<drive::MotorDevice> makeDevice(const ControllerAddress &address) {
    if (address.kind == DeviceKind::Arduino)
        return std::make_unique<drive::ArduinoDevice>();
    return std::make_unique<roboclaw::Device>(std::uint8_t(address.address));
}

QString placeOf(const ControllerAddress &address) {
    return address.kind == DeviceKind::Arduino
               ? address.url
               : QString("0x%1 on %2").arg(address.address, 0, 16).arg(address.url);
}

} // namespace

MotorController::MotorController(int number, const ControllerAddress &address, int onLine)
    : place_(address)
    , name_(QString("controller %1 (%2)").arg(number).arg(placeOf(address)))
    , onLine_(onLine)
    , device_(makeDevice(address))
    , timeoutAtMost_s_(device_->timeout().atMost_s) {}

void MotorController::configure(const MotorSettings &settings) {
    const double countsPerRadian = settings.countsPerTurn / (2 * vectorlib::pi);
    deceleration_ = std::max(
        1u, quint32(std::llround(settings.emergencyDeceleration / settings.wheelRadius * countsPerRadian)));
    watch_.setThreshold(settings.encoder.moving * countsPerRadian);
    disobeyAfter_s_ = settings.encoder.hold_s;
    fullSpeed_ = settings.pid.qpps;
    promised_s_ = settings.serialTimeout_s;
    if (!device_->configure({settings.pid, promised_s_}) && keepsPromise())
        return;
    timeoutAtMost_s_ = std::max(timeoutAtMost_s_, device_->timeout().seconds);
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

void MotorController::command(const std::array<qint32, 2> &speeds) {
    if (!isReady())
        return;
    if (speeds != zero)
        watch_.doubt();
    else if (speeds_ != zero)
        standBy_ = clock_ + brakingTime() + 3 / rate_Hz().value_or(1 / longestStep_s);
    speeds_ = speeds;
    ++commanded_;
}

void MotorController::beginCycle(double now) {
    const double step = std::clamp(now - std::exchange(lastCycle_, now), 0.0, longestStep_s);
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
            return ask({Kind::SetSpeeds, 0, speeds_, deceleration_}, replyTimeout_s_);
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

void MotorController::finished(const Bus::Outcome &outcome, double now) {
    if (!asked_)
        return; // lost, or to be set up anew, in between
    const Command command = *asked_;
    asked_.reset();
    const bool done = outcome.result == Bus::Result::Done;
    failures_ = done ? 0 : std::min(failures_ + 1, 2);
    heard_ = done || (heard_ && (isReady() || !isFailing()));
    if (done)
        lastAnswer_ = clock_;
    else
        failure_ = outcome.result;
    switch (state_) {
    case State::Stopping:
        return stopAnswered(command, outcome, now);
    case State::SetUp:
        return setupAnswered(command, outcome, now);
    case State::Ready:
        return readyAnswered(command, outcome);
    }
}

void MotorController::keepSilent(const Bus::Outcome &outcome) {
    silentUntil_ = outcome.sent + silence_s();
}

void MotorController::stopAnswered(const Command &command, const Bus::Outcome &outcome, double now) {
    if (command.kind == Kind::SetTimeout) {
        stopStep_ = StopStep::CutPower;
        return;
    }
    if (barred_) {
        error_ = barReason_; // the line may have been closed meanwhile
        silentUntil_ = setPointSent_ + barredSilence_s;
        return;
    }
    if (outcome.result != Bus::Result::Done) {
        watch_.doubt();
        stopStep_ = nextAttempt();
        if (isFirstStop_) // it is told again at once
            return;
        error_ = failureOf(command);
        return keepSilent(outcome); // what came in spite of it may be late, or another one's
    }
    if (command.kind != Kind::ReadEncoders) {
        stopStep_ = StopStep::Look;
        if (isFirstStop_)
            brakeUntil_ = now + brakingTime();
        return watch_.acknowledged();
    }
    watch_.read(device_->counts(), outcome.received);
    nextStop_ = now + readingPause_s;
    if (watch_.isMoving()) {
        if (now < brakeUntil_)
            return;
        error_ = "was told to stop and its wheels turn";
        watch_.doubt();
        stopStep_ = nextAttempt();
        return keepSilent(outcome);
    }
    if (!watch_.stands() || now < nextSetup_)
        return;
    state_ = State::SetUp;
    setupStep_ = 0;
    replyTimes_.clear();
}

void MotorController::failSetup(const QString &reason, double now) {
    lose(reason);
    nextSetup_ = now + setupPause_s;
}

void MotorController::setupAnswered(const Command &command, const Bus::Outcome &outcome, double now) {
    if (outcome.result != Bus::Result::Done && !device_->isVital(command))
        return ++setupStep_, missSlow();
    if (outcome.result != Bus::Result::Done)
        return failSetup(failureOf(command), now);
    replyTimes_.push_back(outcome.received - outcome.sent);
    const std::string fault = device_->take(command, readings_);
    version_ = QString::fromLatin1(device_->version().c_str());
    if (!fault.empty())
        return failSetup(QString::fromLatin1(fault.c_str()), now);
    if (++setupStep_ < device_->setupSteps())
        return;
    if (!keepsPromise())
        return failSetup(QString("stops by itself %1 s after its last command, and that cannot be set: "
                                 "controllers.timeout_s promises %2 s")
                             .arg(device_->timeout().seconds)
                             .arg(promised_s_),
                         now);
    // A round of the line: set-point and encoders of each, and a slow reading.
    const double reply = usualReplyTime(), round = reply * (2 * onLine_ + 1);
    if (round * leastRate_Hz > 1)
        return failSetup(QString("answers after %1 ms; its line gives %2 Hz then, at least %3 are needed")
                             .arg(1000 * reply, 0, 'f', 0)
                             .arg(1 / round, 0, 'f', 1)
                             .arg(leastRate_Hz),
                         now);
    replyTimeout_s_ = std::clamp(3 * reply, shortestReplyTimeout_s, longestDrivingReplyTimeout_s);
    becomeReady();
}

bool MotorController::keepsPromise() const {
    return device_->timeout().seconds <= promised_s_ + rounding_s;
}

double MotorController::usualReplyTime() {
    const auto middle = replyTimes_.begin() + std::ptrdiff_t(replyTimes_.size() / 2);
    std::nth_element(replyTimes_.begin(), middle, replyTimes_.end());
    return *middle;
}

void MotorController::becomeReady() {
    state_ = State::Ready;
    error_.clear();
    timeoutAtMost_s_ = device_->timeout().seconds;
    timeoutKnown_ = true; // it was read back
    lastAnswer_ = lastObeyed_ = lastCounts_ = lastSlow_ = lastDuty_ = clock_;
    countsAsked_ = 0;
    speeds_ = zero;
    toldToTurn_ = false;
    standBy_ = clock_ + disobeyAfter_s_ + timeoutMargin_s;
    ++commanded_;
    ++readings_.setups;
    slow_ = 0;
}

void MotorController::takeCounts(const Bus::Outcome &outcome) {
    const auto before = std::exchange(readings_.counts, device_->counts());
    const double gap = outcome.received - std::exchange(countsAsked_, outcome.sent); // at most
    readings_.countsTime = outcome.received;
    for (std::size_t i = 0; i < before.size() && device_->timeout().isFixed; ++i) {
        if (std::abs(double(qint32(readings_.counts[i] - before[i]))) > overspeed * fullSpeed_ * gap)
            return ++readings_.restarts, lose("its counts have jumped: it has restarted");
    }
    watch_.read(readings_.counts, outcome.received);
    lastCounts_ = clock_;
    rate_.add(clock_);
    wantsEncoders_ = false;
}

void MotorController::nextSlow() {
    wantsSlow_ = false;
    slow_ = (slow_ + 1) % device_->slowReadings();
    if (!device_->isVital({Kind::ReadSlow, slow_}) && !readings_.duty && clock_ < nextDuty_)
        ++slow_; // the last one is vital
}

void MotorController::missSlow() {
    if (isReady() && clock_ - lastDuty_ <= slowLostAfter_s)
        return;
    readings_.duty.reset();
    nextDuty_ = clock_ + dutyPause_s;
}

void MotorController::readyAnswered(const Command &command, const Bus::Outcome &outcome) {
    if (outcome.result != Bus::Result::Done) {
        if (!device_->isVital(command))
            missSlow(), nextSlow();
        return; // all else is repeated with what is then due
    }
    if (command.kind == Kind::SetSpeeds) {
        lastObeyed_ = clock_;
        obeyed_ = sent_;
        if (!toldToTurn_)
            watch_.acknowledged();
        return;
    }
    if (command.kind == Kind::ReadEncoders)
        return takeCounts(outcome);
    const std::string fault = device_->take(command, readings_);
    if (!device_->isVital(command))
        lastDuty_ = clock_;
    nextSlow();
    if (slow_ == 0)
        lastSlow_ = clock_;
    if (fault.empty())
        return;
    timeoutKnown_ = false;
    lose(QString::fromLatin1(fault.c_str()) + "; it was without power, or somebody else has set it");
}

} // namespace hermes::motorcontrol
