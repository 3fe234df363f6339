#include "daemons/motorcontrol/MotorController.h"

#include "protocol/roboclaw/Status.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hermes {

using roboclaw::Bus;
using roboclaw::Command;
using roboclaw::Request;

namespace {

constexpr double setupPause_s = 0.25; // between attempts at a controller that does not answer

constexpr double longestStep_s = 0.04; // a cycle that came later: this program stood still, and asked nothing

constexpr Command setPids[] = {Command::SetVelocityPidM1, Command::SetVelocityPidM2};
constexpr Command readPids[] = {Command::ReadVelocityPidM1, Command::ReadVelocityPidM2};

// 16.16 fixed point
qint64 fixedPoint(double value) {
    return std::llround(value * 65536);
}

QString toText(Bus::Result result) {
    switch (result) {
    case Bus::Result::BadCrc:
        return "answers with a wrong checksum";
    case Bus::Result::Unexpected:
        return "answers with something unexpected";
    case Bus::Result::LineClosed:
        return "has no line";
    default:
        return "does not answer";
    }
}

} // namespace

MotorController::MotorController(int number, const ControllerAddress &address)
    : place_(address)
    , name_(QString("controller %1 (0x%2 on %3)").arg(number).arg(address.address, 0, 16).arg(address.url)) {}

void MotorController::configure(const MotorSettings &settings) {
    const int tenths = std::max(1, int(std::lround(10 * settings.serialTimeout_s)));
    if (pid_ == settings.pid && timeoutTenths_ == tenths)
        return;
    pid_ = settings.pid;
    timeoutTenths_ = tenths;
    if (isReady())
        lose("is being set up with new settings");
}

void MotorController::lineClosed(const QString &reason) {
    lose(reason);
    nextAttempt_ = 0;
}

void MotorController::lose(const QString &reason) {
    step_ = 0;
    error_ = reason;
    readings_.countsTime = 0;
    readings_.complete = false;
    awaits_ = wantsEncoders_ = wantsSlow_ = false;
    obeyed_ = commanded_;
}

void MotorController::command(const std::array<qint32, 2> &speeds, quint32 acceleration) {
    if (!isReady())
        return;
    speeds_ = speeds;
    acceleration_ = std::max(1u, acceleration);
    ++commanded_;
}

void MotorController::beginCycle(double now) {
    const double step = std::min(now - std::exchange(lastCycle_, now), longestStep_s);
    if (!isReady())
        return;
    sinceObeyed_ += step;
    sinceCounts_ += step;
    if (std::max(sinceObeyed_, sinceCounts_) > lostAfter_s)
        return lose(error_.isEmpty() ? "was not heard" : error_);
    overruns_ += wantsEncoders_;
    wantsEncoders_ = wantsSlow_ = true;
}

Request MotorController::request(Command command, const roboclaw::Values &values) const {
    return *Request::make(address(), command, values);
}

std::optional<Request> MotorController::next(Task task, double now) {
    const auto request = due(task, now);
    if (request) {
        awaits_ = true;
        sent_ = commanded_;
    }
    return request;
}

std::optional<Request> MotorController::due(Task task, double now) const {
    switch (task) {
    case Task::SetPoint:
        if (obeyed_ != commanded_)
            return request(Command::SpeedAccel, {acceleration_, speeds_[0], speeds_[1]});
        break;
    case Task::Encoders:
        if (wantsEncoders_)
            return request(Command::ReadEncoders);
        break;
    case Task::Background:
        if (!isReady() && now >= nextAttempt_)
            return setupRequest();
        if (isReady() && wantsSlow_)
            return slowRequest();
        break;
    }
    return std::nullopt;
}

Request MotorController::setupRequest() const {
    const int motor = step_ >= 5;
    switch (step_) {
    case 0:
        return request(Command::ReadVersion);
    case 1:
        return request(Command::SetSerialTimeout, {timeoutTenths_});
    case 2:
        return request(Command::ReadSerialTimeout);
    case 3:
    case 5:
        return request(setPids[motor],
                       {fixedPoint(pid_.d), fixedPoint(pid_.p), fixedPoint(pid_.i), pid_.qpps});
    default:
        return request(readPids[motor]);
    }
}

QString MotorController::setupFault(const roboclaw::Reply &reply) const {
    if (step_ == 0 && !QString::fromLatin1(reply.text.data()).contains("roboclaw", Qt::CaseInsensitive))
        return QString("tells its version as \"%1\", expected that of a RoboClaw")
            .arg(QString::fromLatin1(reply.text.data()));
    if (step_ == 2 && reply[0] != timeoutTenths_)
        return QString("has a time-out of %1 s, expected the %2 s that were written")
            .arg(double(reply[0]) / 10)
            .arg(timeoutTenths_ / 10.0);
    if (step_ == 4 || step_ == 6) {
        const qint64 expected[] = {fixedPoint(pid_.p), fixedPoint(pid_.i), fixedPoint(pid_.d), pid_.qpps};
        const char *const names[] = {"P", "I", "D", "QPPS"};
        for (int i = 0; i < 4; ++i) {
            if (reply[size_t(i)] != expected[i])
                return QString("has %1 = %2 for M%3, expected the %4 that was written")
                    .arg(names[i])
                    .arg(i < 3 ? double(reply[size_t(i)]) / 65536 : double(reply[size_t(i)]))
                    .arg(step_ == 4 ? 1 : 2)
                    .arg(i < 3 ? double(expected[i]) / 65536 : double(expected[i]));
        }
    }
    return {};
}

void MotorController::takeSetup(const Bus::Outcome &outcome, double now) {
    if (outcome.result == Bus::Result::Done) {
        const QString fault = setupFault(outcome.reply);
        if (!fault.isEmpty()) {
            lose(fault);
            nextAttempt_ = now + setupPause_s;
            return;
        }
        if (step_ == 0)
            version_ = QString::fromLatin1(outcome.reply.text.data());
        if (++step_ == setupSteps) {
            sinceObeyed_ = sinceCounts_ = 0;
            ++readings_.setups;
            error_.clear();
        }
        return;
    }
    lose(toText(outcome.result));
    nextAttempt_ = now + setupPause_s;
}

Request MotorController::slowRequest() const {
    static constexpr Command readings[slowReadings] = {Command::ReadStatus, Command::ReadCurrents,
                                                       Command::ReadMainBattery, Command::ReadTemperature,
                                                       Command::ReadLogicBattery};
    return request(readings[slow_]);
}

void MotorController::takeSlow(const Bus::Outcome &outcome) {
    const roboclaw::Reply &reply = outcome.reply;
    switch (slow_) {
    case 0:
        readings_.status = roboclaw::statusOf(reply, outcome.dialect);
        break;
    case 1:
        readings_.current_a = {double(reply[0]) / 100, double(reply[1]) / 100};
        break;
    case 2:
        readings_.battery_v = double(reply[0]) / 10;
        break;
    case 3:
        readings_.temperature_c = double(reply[0]) / 10;
        break;
    case 4:
        readings_.logic_v = double(reply[0]) / 10;
        readings_.complete = true;
        break;
    }
    slow_ = (slow_ + 1) % slowReadings;
}

void MotorController::finished(Task task, const Bus::Outcome &outcome, double now) {
    if (!awaits_)
        return; // lost, or to be set up anew, in between
    awaits_ = false;
    if (outcome.result == Bus::Result::Cancelled)
        return; // never sent
    failures_ = outcome.result == Bus::Result::Done ? 0 : std::min(failures_ + 1, 2);
    if (!isReady())
        return takeSetup(outcome, now);
    if (outcome.result != Bus::Result::Done) {
        error_ = toText(outcome.result); // repeated with what is then due
        return;
    }
    switch (task) {
    case Task::SetPoint:
        sinceObeyed_ = 0;
        obeyed_ = sent_;
        break;
    case Task::Encoders:
        readings_.counts = {quint32(outcome.reply[0]), quint32(outcome.reply[1])};
        readings_.countsTime = outcome.received;
        sinceCounts_ = 0;
        wantsEncoders_ = false;
        error_.clear();
        break;
    case Task::Background:
        takeSlow(outcome);
        wantsSlow_ = false;
        break;
    }
}

} // namespace hermes
