// What follows from the answers of a motor controller.
#include "daemons/motorcontrol/MotorController.h"

#include <algorithm>
#include <cmath>

namespace hermes::motorcontrol {

using drive::Bus;
using drive::Command;
using Kind = Command::Kind;

namespace {

constexpr double setupPause_s = 0.25; // between attempts at a controller that cannot be set up
constexpr double barredSilence_s = 5;
constexpr double readingPause_s = 0.02; // while it is seen to stand
constexpr double dutyPause_s = 10;      // a request that is not answered holds up a stop on its line
constexpr double rounding_s = 1e-6;

} // namespace

void MotorController::finished(const Bus::Outcome &outcome, double now) {
    if (!asked_)
        return; // lost, or to be set up anew, in between
    const Command command = *asked_;
    asked_.reset();
    const bool done = outcome.result == Bus::Result::Done;
    failures_ = done ? 0 : std::min(failures_ + 1, 2);
    heard_ = done || (heard_ && (isReady() || !isFailing()));
    if (done) {
        lastAnswer_ = clock_;
        answered_ = awake_;
    } else
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
    if (!watch_.stands())
        return;
    if (awake_ >= brakesUntil_)
        turnsUntil_ = 0;
    if (now < nextSetup_)
        return;
    state_ = State::SetUp;
    setupStep_ = 0;
    replyTimes_.clear();
}

void MotorController::failSetup(const QString &reason, double now) {
    lose(reason);
    nextSetup_ = now + setupPause_s;
}

// It answers as it did while it was seen to stand: what is known of that holds.
void MotorController::refuseSetup(const QString &reason, double now) {
    const StandstillWatch standing = watch_;
    failSetup(reason, now);
    watch_ = standing;
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
        return refuseSetup(QString::fromLatin1(fault.c_str()), now);
    if (++setupStep_ < device_->setupSteps())
        return;
    if (!keepsPromise())
        return refuseSetup(QString("stops by itself %1 s after its last command, and that cannot be set: "
                                   "controllers.timeout_s promises %2 s")
                               .arg(device_->timeout().seconds)
                               .arg(promised_s_),
                           now);
    // A round of the line: set-point and encoders of each, and a slow reading.
    const double reply = usualReplyTime(), round = reply * (2 * onLine_ + 1);
    if (round * leastRate_Hz > 1)
        return refuseSetup(QString("answers after %1 ms; its line gives %2 Hz then, at least %3 are needed")
                               .arg(1000 * reply, 0, 'f', 0)
                               .arg(1 / round, 0, 'f', 1)
                               .arg(leastRate_Hz),
                           now);
    replyTimeout_s_ = std::clamp(3 * reply, shortestReplyTimeout_s, longestDrivingReplyTimeout_s);
    becomeReady();
}

bool MotorController::keepsPromise() const {
    const double seconds = device_->timeout().seconds;
    return seconds <= promised_s_ + rounding_s || (std::isinf(seconds) && mayLackTimeout_);
}

double MotorController::usualReplyTime() {
    const auto middle = replyTimes_.begin() + std::ptrdiff_t(replyTimes_.size() / 2);
    std::nth_element(replyTimes_.begin(), middle, replyTimes_.end());
    return *middle;
}

void MotorController::becomeReady() {
    state_ = State::Ready;
    error_.clear();
    timeoutAtMost_s_ = device_->timeout().silence_s();
    timeoutKnown_ = true; // it was read back
    lastAnswer_ = lastObeyed_ = lastCounts_ = lastSlow_ = lastDuty_ = clock_;
    restarts_.begin();
    speeds_ = {};
    toldToTurn_ = false;
    turnsUntil_ = 0;
    standBy_ = clock_ + disobeyAfter_s_ + timeoutMargin_s;
    ++commanded_;
    ++readings_.setups;
    slow_ = 0;
}

void MotorController::takeCounts(const Bus::Outcome &outcome) {
    const auto counts = device_->counts();
    if (device_->timeout().isFixed) {
        const auto verdict = restarts_.judge(counts, outcome, overspeed * fullSpeed_);
        if (verdict == RestartWatch::Verdict::Restarted)
            ++readings_.restarts,
                lose("its counts have jumped: it has restarted, or turns faster than pid.qpps");
        if (verdict != RestartWatch::Verdict::Plausible)
            return;
    } else if (RestartWatch::beganAnew(readings_, counts, outcome, overspeed * fullSpeed_)) {
        ++readings_.restarts;
        timeoutKnown_ = false;
        return lose("its counts begin anew: it was without power");
    }
    readings_.counts = counts;
    readings_.countsTime = outcome.received;
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
    if (outcome.attempts > 1)
        restarts_.missed();
    if (outcome.result != Bus::Result::Done) {
        restarts_.missed();
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
    const auto dutyBefore = std::exchange(readings_.duty, std::nullopt);
    const std::string fault = device_->take(command, readings_);
    if (readings_.duty)
        lastDuty_ = clock_;
    else
        readings_.duty = dutyBefore;
    nextSlow();
    if (slow_ == 0)
        lastSlow_ = clock_;
    if (fault.empty())
        return;
    timeoutKnown_ = false;
    lose(QString::fromLatin1(fault.c_str()) +
         (device_->timeout().isFixed ? "" : "; it was without power, or somebody else has set it"));
}

} // namespace hermes::motorcontrol
