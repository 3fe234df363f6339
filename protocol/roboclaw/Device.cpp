#include "protocol/roboclaw/Device.h"

#include "protocol/roboclaw/Status.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace hermes::roboclaw {

namespace {

using Kind = drive::Command::Kind;

constexpr Command setPids[] = {Command::SetVelocityPidM1, Command::SetVelocityPidM2};
constexpr Command readPids[] = {Command::ReadVelocityPidM1, Command::ReadVelocityPidM2};
constexpr Command slowCommands[] = {
    Command::ReadStatus,      Command::ReadCurrents,     Command::ReadPwm,          Command::ReadMainBattery,
    Command::ReadTemperature, Command::ReadLogicBattery, Command::ReadSerialTimeout};
constexpr int slowCount = int(std::size(slowCommands)), settingSteps = 7;

// 16.16 fixed point
std::int64_t fixedPoint(double value) {
    return std::llround(value * 65536);
}

int tenthsOf(double seconds) {
    return std::max(1, int(10 * seconds + 1e-6)); // never longer than it is set
}

// Full duty is 32767; a controller that tells -32768 means the same.
double dutyOf(std::int64_t pwm) {
    return std::clamp(double(pwm) / 32767, -1.0, 1.0);
}

template <class... Parts>
std::string textOf(const Parts &...parts) {
    std::ostringstream text;
    (text << ... << parts);
    return text.str();
}

bool isRoboClaw(std::string version) {
    for (char &letter : version)
        letter = letter >= 'A' && letter <= 'Z' ? char(letter + 'a' - 'A') : letter;
    return version.find("roboclaw") != std::string::npos;
}

} // namespace

bool Device::configure(const drive::DeviceSettings &settings) {
    const int tenths = tenthsOf(std::min(settings.timeout_s, longestTimeout_s));
    const bool differs = !(settings.pid == pid_) || tenths != timeoutTenths_;
    pid_ = settings.pid;
    timeoutTenths_ = tenths;
    return differs;
}

int Device::setupSteps() const {
    return settingSteps + slowCount;
}

int Device::slowReadings() const {
    return slowCount;
}

// Only the gauge of the battery needs the duties.
bool Device::isVital(const drive::Command &command) const {
    return request(command).command != Command::ReadPwm;
}

Request Device::request(const drive::Command &command) const {
    switch (command.kind) {
    case Kind::SetSpeeds:
        return *Request::make(address_, Command::SpeedAccel,
                              {command.deceleration, command.speeds[0], command.speeds[1]});
    case Kind::CutPower:
        return *Request::make(address_, Command::Duty, {0, 0});
    case Kind::SetTimeout:
        return *Request::make(address_, Command::SetSerialTimeout, {timeoutTenths_});
    case Kind::ReadSlow:
        return *Request::make(address_, slowCommands[command.number]);
    case Kind::SetUp:
        return setupRequest(command.number);
    case Kind::ReadEncoders:
        break;
    }
    return *Request::make(address_, Command::ReadEncoders);
}

Request Device::setupRequest(int step) const {
    const int motor = step >= 5;
    switch (step) {
    case 0:
        return *Request::make(address_, Command::ReadVersion);
    case 1:
        return request({Kind::SetTimeout});
    case 2:
        return *Request::make(address_, Command::ReadSerialTimeout);
    case 3:
    case 5:
        return *Request::make(address_, setPids[motor],
                              {fixedPoint(pid_.d), fixedPoint(pid_.p), fixedPoint(pid_.i), pid_.qpps});
    case 4:
    case 6:
        return *Request::make(address_, readPids[motor]);
    default:
        return request({Kind::ReadSlow, step - settingSteps});
    }
}

drive::MotorDevice::Name Device::nameOf(const drive::Command &command) const {
    const Command asked = request(command).command;
    switch (asked) {
    case Command::SpeedAccel:
        return {"40 (speeds)"};
    case Command::Duty:
        return {"34 (duties)"};
    case Command::SetSerialTimeout:
        return {"14 (set serial time-out)",
                "its firmware may be older than that command, and it would not stop by itself"};
    case Command::ReadSerialTimeout:
        return {"15 (serial time-out)"};
    case Command::ReadEncoders:
        return {"78 (encoders)"};
    case Command::ReadVersion:
        return {"21 (version)"};
    case Command::ReadStatus:
        return {"90 (status)"};
    case Command::ReadCurrents:
        return {"49 (currents)"};
    case Command::ReadPwm:
        return {"48 (duties)"};
    case Command::ReadMainBattery:
        return {"24 (main battery)"};
    case Command::ReadLogicBattery:
        return {"25 (logic battery)"};
    case Command::ReadTemperature:
        return {"82 (temperature)"};
    default:
        return {std::to_string(int(asked)) + " (velocity PID)"};
    }
}

std::string Device::timeoutFault() const {
    const std::int64_t tenths = parser_.reply()[0];
    if (tenths == timeoutTenths_)
        return {};
    return textOf("has a time-out of ", double(tenths) / 10, " s, expected the ", timeoutTenths_ / 10.0,
                  " s that were written");
}

std::string Device::pidFault(int motor) const {
    const std::int64_t expected[] = {fixedPoint(pid_.p), fixedPoint(pid_.i), fixedPoint(pid_.d), pid_.qpps};
    const char *const names[] = {"P", "I", "D", "QPPS"};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::int64_t told = parser_.reply()[i];
        if (told == expected[i])
            continue;
        const double unit = i < 3 ? 65536 : 1;
        return textOf("has ", names[i], " = ", double(told) / unit, " for M", motor, ", expected the ",
                      double(expected[i]) / unit, " that was written");
    }
    return {};
}

std::string Device::setupFault(int step) const {
    const std::string version = parser_.reply().text.data();
    switch (step) {
    case 0:
        return isRoboClaw(version) ? std::string()
                                   : "tells its version as \"" + version + "\", expected that of a RoboClaw";
    case 2:
        return timeoutFault();
    case 4:
        return pidFault(1);
    case 6:
        return pidFault(2);
    default:
        return {};
    }
}

std::string Device::take(const drive::Command &command, drive::Readings &readings) {
    if (command.kind == Kind::ReadSlow)
        return takeSlow(command.number, readings);
    const int step = command.number;
    const std::string wrong = setupFault(step);
    if (!wrong.empty())
        return wrong;
    const Reply &reply = parser_.reply();
    if (step == 0)
        version_ = std::string(reply.text.data()) +
                   (reply.endsWithLineFeed ? "" : " (without the line feed that should end it)");
    if (step >= settingSteps)
        takeSlow(step - settingSteps, readings);
    return {};
}

std::string Device::takeSlow(int reading, drive::Readings &readings) const {
    const Reply &reply = parser_.reply();
    switch (slowCommands[reading]) {
    case Command::ReadStatus:
        readings.status = statusOf(reply, parser_.dialect());
        break;
    case Command::ReadCurrents:
        readings.current_a = {double(reply[0]) / 100, double(reply[1]) / 100};
        break;
    case Command::ReadPwm:
        readings.duty = {dutyOf(reply[0]), dutyOf(reply[1])};
        break;
    case Command::ReadMainBattery:
        readings.battery_v = double(reply[0]) / 10;
        break;
    case Command::ReadTemperature:
        readings.temperature_c = double(reply[0]) / 10;
        break;
    case Command::ReadLogicBattery:
        readings.logic_v = double(reply[0]) / 10;
        break;
    default:
        readings.complete = true;
        return timeoutFault();
    }
    return {};
}

std::array<std::uint32_t, 2> Device::counts() const {
    return {std::uint32_t(parser_.reply()[0]), std::uint32_t(parser_.reply()[1])};
}

} // namespace hermes::roboclaw
