#include "daemons/motorcontrol/ControllerSetup.h"

#include <algorithm>
#include <cmath>

namespace hermes::motorcontrol {

using roboclaw::Command;
using roboclaw::Request;

namespace {

constexpr Command setPids[] = {Command::SetVelocityPidM1, Command::SetVelocityPidM2};
constexpr Command readPids[] = {Command::ReadVelocityPidM1, Command::ReadVelocityPidM2};

// 16.16 fixed point
qint64 fixedPoint(double value) {
    return std::llround(value * 65536);
}

int tenthsOf(double seconds) {
    return std::max(1, int(10 * seconds + 1e-6)); // never longer than it is set
}

} // namespace

void ControllerSetup::configure(const MotorSettings &settings) {
    pid_ = settings.pid;
    timeoutTenths_ = tenthsOf(settings.serialTimeout_s);
}

bool ControllerSetup::differs(const MotorSettings &settings) const {
    return !(pid_ == settings.pid) || timeoutTenths_ != tenthsOf(settings.serialTimeout_s);
}

Request ControllerSetup::request(quint8 address) const {
    const int motor = step_ >= 5;
    switch (step_) {
    case 0:
        return *Request::make(address, Command::ReadVersion);
    case 1:
        return *Request::make(address, Command::SetSerialTimeout, {timeoutTenths_});
    case 2:
        return *Request::make(address, Command::ReadSerialTimeout);
    case 3:
    case 5:
        return *Request::make(address, setPids[motor],
                              {fixedPoint(pid_.d), fixedPoint(pid_.p), fixedPoint(pid_.i), pid_.qpps});
    case 4:
    case 6:
        return *Request::make(address, readPids[motor]);
    default:
        return *Request::make(address, ControllerReadings::slowCommand(step_ - settingSteps));
    }
}

QString ControllerSetup::timeoutFault(qint64 tenths) const {
    if (tenths == timeoutTenths_)
        return {};
    return QString("has a time-out of %1 s, expected the %2 s that were written")
        .arg(double(tenths) / 10)
        .arg(timeout_s());
}

QString ControllerSetup::pidFault(int motor, const roboclaw::Reply &reply) const {
    const qint64 expected[] = {fixedPoint(pid_.p), fixedPoint(pid_.i), fixedPoint(pid_.d), pid_.qpps};
    const char *const names[] = {"P", "I", "D", "QPPS"};
    for (int i = 0; i < 4; ++i) {
        if (reply[size_t(i)] == expected[i])
            continue;
        const double unit = i < 3 ? 65536 : 1;
        return QString("has %1 = %2 for M%3, expected the %4 that was written")
            .arg(names[i])
            .arg(double(reply[size_t(i)]) / unit)
            .arg(motor)
            .arg(double(expected[i]) / unit);
    }
    return {};
}

QString ControllerSetup::fault(const roboclaw::Reply &reply) const {
    const QString version = QString::fromLatin1(reply.text.data());
    switch (step_) {
    case 0:
        return version.contains("roboclaw", Qt::CaseInsensitive)
                   ? QString()
                   : QString("tells its version as \"%1\", expected that of a RoboClaw").arg(version);
    case 2:
        return timeoutFault(reply[0]);
    case 4:
        return pidFault(1, reply);
    case 6:
        return pidFault(2, reply);
    default:
        return {};
    }
}

QString ControllerSetup::take(const roboclaw::Bus::Outcome &outcome, ControllerReadings &readings) {
    const QString wrong = fault(outcome.reply);
    if (!wrong.isEmpty())
        return wrong;
    if (step_ == 0)
        version_ = QString::fromLatin1(outcome.reply.text.data()) +
                   (outcome.reply.endsWithLineFeed ? "" : " (without the line feed that should end it)");
    if (step_ >= settingSteps)
        readings.takeSlow(step_ - settingSteps, outcome);
    ++step_;
    return {};
}

} // namespace hermes::motorcontrol
