#include "daemons/simulator/RoboClawEmulator.h"

#include <algorithm>
#include <cmath>

namespace hermes {

using namespace roboclaw;

namespace {

constexpr double longestGap = 0.010; // seconds between the bytes of one packet
constexpr double fullDuty = 32767;
constexpr double fixedPoint = 65536; // of PID gains
constexpr double tenths = 10;        // of a volt, of a degree
constexpr double centiampere = 100;
constexpr double logicVoltage = 5;
constexpr double warmth = 0.03, cooling = 60; // degrees for each A^2 at last, with this time constant (s)
constexpr double hot = 85, tooHot = 100;      // data sheet: the current falls from 85 degrees, to none at 100

std::int64_t rounded(double value, std::int64_t least, std::int64_t most) {
    return std::clamp<std::int64_t>(std::llround(value), least, most);
}

std::int64_t speedOf(const MotorChannel &channel) {
    return rounded(channel.measuredSpeed(), INT32_MIN, INT32_MAX);
}

MotorChannel::Pid pidOf(const Values &v) {
    return {double(v[1]) / fixedPoint, double(v[2]) / fixedPoint, double(v[0]) / fixedPoint, double(v[3])};
}

Values valuesOf(const MotorChannel::Pid &pid) {
    const auto fixed = [](double gain) { return std::llround(gain * fixedPoint); };
    return {fixed(pid.p), fixed(pid.i), fixed(pid.d), std::llround(pid.qpps)};
}

std::uint32_t eepromKey(std::int64_t address) {
    return 0x100U + std::uint32_t(address);
}

/// Which command sets what a read tells; the values are in the same order but for the position PID.
struct Stored {
    Command read;
    Command write;
    Values initially;
};
const Stored stored[] = {
    {Command::ReadMainLimits, Command::SetMainLimits, {60, 340}},
    {Command::ReadLogicLimits, Command::SetLogicLimits, {55, 340}},
    {Command::ReadPositionPidM1, Command::SetPositionPidM1, {0, 0, 0, 0, 0, 0, 0}},
    {Command::ReadPositionPidM2, Command::SetPositionPidM2, {0, 0, 0, 0, 0, 0, 0}},
    {Command::ReadPinModes, Command::SetPinModes, {0, 0, 0}},
    {Command::ReadConfig, Command::SetConfig, {0x01A3}},
    {Command::ReadSpeedErrorLimits, Command::SetSpeedErrorLimits, {0, 0}},
    {Command::ReadPositionErrorLimits, Command::SetPositionErrorLimits, {0, 0}},
    {Command::ReadMaxCurrentM1, Command::SetMaxCurrentM1, {6000, 0}},
    {Command::ReadMaxCurrentM2, Command::SetMaxCurrentM2, {6000, 0}},
    {Command::ReadPwmMode, Command::SetPwmMode, {0}},
};

} // namespace

RoboClawEmulator::RoboClawEmulator(const Options &options)
    : options_(options)
    , channels_{MotorChannel(options.motor), MotorChannel(options.motor)}
    , random_(options.seed) {}

std::optional<RoboClawEmulator::Answer> RoboClawEmulator::receive(std::uint8_t byte, double now) {
    if (now - lastByte_ > longestGap)
        parser_.silence();
    lastByte_ = now;
    if (faults_.silent)
        return {};
    silence_ = 0;
    const RequestParser::Result result = parser_.feed(byte);
    counts_.crcErrors += result == RequestParser::Result::BadCrc;
    counts_.unknown += result == RequestParser::Result::Unknown;
    if (result != RequestParser::Result::Done)
        return {};
    const Request &request = parser_.request();
    if (request.address != options_.address && !options_.anyAddress)
        return {};
    const std::optional<Bytes> bytes = execute(request);
    if (!bytes)
        return {};
    ++counts_.requests;
    return damaged(*bytes);
}

std::optional<RoboClawEmulator::Answer> RoboClawEmulator::damaged(const Bytes &bytes) {
    if (chance(faults_.drop))
        return {};
    if (!chance(faults_.corrupt))
        return Answer{bytes, faults_.delay};
    const std::size_t bit = random_() % (bytes.size() * 8);
    Answer answer{{}, faults_.delay};
    for (std::size_t i = 0; i < bytes.size(); ++i)
        answer.bytes.push(std::uint8_t(bytes[i] ^ (bit / 8 == i ? 1 << bit % 8 : 0)));
    return answer;
}

bool RoboClawEmulator::chance(double probability) {
    return probability > 0 && std::uniform_real_distribution<double>()(random_) < probability;
}

void RoboClawEmulator::advance(double seconds, double voltage, double ambient) {
    voltage_ = voltage;
    silence_ += seconds;
    const bool timedOut = timeoutTenths_ > 0 && silence_ >= serialTimeout();
    if (timedOut && silence_ - seconds < serialTimeout())
        ++counts_.timeouts;
    const bool powered = !faults_.silent && !(status() & MainVoltageLowError);
    double heat = 0;
    for (MotorChannel &channel : channels_) {
        if (timedOut || isStopped() || faults_.silent)
            channel.stop();
        channel.advance(seconds, voltage, powered);
        heat += channel.current() * channel.current() * warmth;
    }
    temperature_ += (ambient + heat - temperature_) * (1 - std::exp(-seconds / cooling));
}

bool RoboClawEmulator::isStopped() const {
    return status() & (EmergencyStop | TemperatureError | DriverFaultM1 | DriverFaultM2);
}

std::uint32_t RoboClawEmulator::status() const {
    const auto limits = readStored(Command::ReadMainLimits, {});
    std::uint32_t bits = faults_.status;
    const auto set = [&bits](bool on, StatusBit bit) { bits |= on ? std::uint32_t(bit) : 0; };
    set(voltage_ < double((*limits)[0]) / tenths, MainVoltageLowError);
    set(voltage_ > double((*limits)[1]) / tenths, MainVoltageHighError);
    set(temperature_ > hot, TemperatureWarning);
    set(temperature_ > tooHot, TemperatureError);
    set(channels_[0].isLimited(), OverCurrentWarningM1);
    set(channels_[1].isLimited(), OverCurrentWarningM2);
    return bits;
}

std::optional<Bytes> RoboClawEmulator::execute(const Request &request) {
    if (!request.isRead()) {
        if (!drive(request) && !driveDistance(request) && !store(request))
            return {};
        Bytes answer;
        answer.push(acknowledgement);
        return answer;
    }
    if (request.command == Command::ReadVersion)
        return encodeText(request, options_.version);
    if (request.command == Command::ReadStatus) {
        const bool old = options_.status == Dialect::Other;
        return encodeReply(request, {old ? oldStatusOf(status()) : status()}, options_.status);
    }
    auto values = read(request.command);
    if (!values)
        values = readStored(request.command, request.values);
    return values ? encodeReply(request, *values) : std::nullopt;
}

bool RoboClawEmulator::drive(const Request &request) {
    const Values &v = request.values;
    auto &[m1, m2] = channels_;
    const auto duty = [&](std::size_t i) { return double(v[i]) / fullDuty; };
    const auto share = [&] { return double(v[0]) / 127; };
    const auto around64 = [&] { return double(v[0] - 64) / (v[0] < 64 ? 64 : 63); };
    const auto speed = [&](std::size_t i) { return double(v[i]); };
    switch (request.command) {
    case Command::ForwardM1:
        return m1.driveDuty(share()), true;
    case Command::BackwardM1:
        return m1.driveDuty(-share()), true;
    case Command::ForwardM2:
        return m2.driveDuty(share()), true;
    case Command::BackwardM2:
        return m2.driveDuty(-share()), true;
    case Command::DriveM1:
        return m1.driveDuty(around64()), true;
    case Command::DriveM2:
        return m2.driveDuty(around64()), true;
    case Command::DutyM1:
        return m1.driveDuty(duty(0)), true;
    case Command::DutyM2:
        return m2.driveDuty(duty(0)), true;
    case Command::Duty:
        return m1.driveDuty(duty(0)), m2.driveDuty(duty(1)), true;
    case Command::DutyAccelM1:
        return m1.driveDuty(duty(0), duty(1)), true;
    case Command::DutyAccelM2:
        return m2.driveDuty(duty(0), duty(1)), true;
    case Command::DutyAccel:
        return m1.driveDuty(duty(0), duty(1)), m2.driveDuty(duty(2), duty(3)), true;
    case Command::SpeedM1:
        return m1.driveSpeed(speed(0)), true;
    case Command::SpeedM2:
        return m2.driveSpeed(speed(0)), true;
    case Command::Speed:
        return m1.driveSpeed(speed(0)), m2.driveSpeed(speed(1)), true;
    case Command::SpeedAccelM1:
        return m1.driveSpeed(speed(1), speed(0)), true;
    case Command::SpeedAccelM2:
        return m2.driveSpeed(speed(1), speed(0)), true;
    case Command::SpeedAccel:
        return m1.driveSpeed(speed(1), speed(0)), m2.driveSpeed(speed(2), speed(0)), true;
    case Command::SpeedAccel2:
        return m1.driveSpeed(speed(1), speed(0)), m2.driveSpeed(speed(3), speed(2)), true;
    default:
        return false;
    }
}

bool RoboClawEmulator::driveDistance(const Request &request) {
    const Values &v = request.values;
    const auto move = [&](int motor, std::size_t speed, double acceleration) {
        const MotorChannel::Move stretch{double(v[speed]), acceleration, double(v[speed + 1])};
        channel(motor).addMove(stretch, v[v.size() - 1] == 1);
    };
    switch (request.command) {
    case Command::SpeedDistanceM1:
        return move(0, 0, MotorChannel::atOnce), true;
    case Command::SpeedDistanceM2:
        return move(1, 0, MotorChannel::atOnce), true;
    case Command::SpeedDistance:
        return move(0, 0, MotorChannel::atOnce), move(1, 2, MotorChannel::atOnce), true;
    case Command::SpeedAccelDistanceM1:
        return move(0, 1, double(v[0])), true;
    case Command::SpeedAccelDistanceM2:
        return move(1, 1, double(v[0])), true;
    case Command::SpeedAccelDistance:
        return move(0, 1, double(v[0])), move(1, 3, double(v[0])), true;
    case Command::SpeedAccelDistance2:
        return move(0, 1, double(v[0])), move(1, 4, double(v[3])), true;
    default:
        return false;
    }
}

bool RoboClawEmulator::store(const Request &request) {
    const Values &v = request.values;
    auto &[m1, m2] = channels_;
    switch (request.command) {
    case Command::SetSerialTimeout:
        timeoutTenths_ = int(v[0]);
        return true;
    case Command::ResetEncoders:
        return m1.setCount(0), m2.setCount(0), true;
    case Command::SetEncoderM1:
        return m1.setCount(std::int32_t(v[0])), true;
    case Command::SetEncoderM2:
        return m2.setCount(std::int32_t(v[0])), true;
    case Command::SetVelocityPidM1:
        return m1.setPid(pidOf(v)), true;
    case Command::SetVelocityPidM2:
        return m2.setPid(pidOf(v)), true;
    case Command::WriteSettings:
        return v[0] == writeSettingsKey;
    case Command::WriteEeprom:
        stored_[eepromKey(v[0])] = {v[1]};
        return true;
    case Command::SetMaxCurrentM1:
        m1.setCurrentLimit(double(v[0]) / centiampere);
        break;
    case Command::SetMaxCurrentM2:
        m2.setCurrentLimit(double(v[0]) / centiampere);
        break;
    case Command::MixedForward:
    case Command::MixedBackward:
    case Command::MixedRight:
    case Command::MixedLeft:
    case Command::MixedDrive:
    case Command::MixedTurn:
    case Command::PositionM1:
    case Command::PositionM2:
    case Command::Position:
        return false;
    default:
        break;
    }
    stored_[std::uint32_t(request.command)] = v;
    return true;
}

std::optional<Values> RoboClawEmulator::read(Command command) {
    const auto &[m1, m2] = channels_;
    const auto count = [](const MotorChannel &m) { return std::int64_t(std::uint32_t(m.count())); };
    const auto backward = [](const MotorChannel &m) { return std::int64_t(m.measuredSpeed() < 0); };
    const auto current = [](const MotorChannel &m) {
        return rounded(m.current() * centiampere, INT16_MIN, INT16_MAX);
    };
    switch (command) {
    case Command::ReadSerialTimeout:
        return Values{timeoutTenths_};
    case Command::ReadEncoderM1:
        return Values{count(m1), 2 * backward(m1)};
    case Command::ReadEncoderM2:
        return Values{count(m2), 2 * backward(m2)};
    case Command::ReadEncoders:
        return Values{count(m1), count(m2)};
    case Command::ReadSpeedM1:
    case Command::ReadRawSpeedM1:
        return Values{speedOf(m1), backward(m1)};
    case Command::ReadSpeedM2:
    case Command::ReadRawSpeedM2:
        return Values{speedOf(m2), backward(m2)};
    case Command::ReadRawSpeeds:
    case Command::ReadAverageSpeeds:
        return Values{speedOf(m1), speedOf(m2)};
    case Command::ReadMainBattery:
        return Values{rounded(voltage_ * tenths, 0, UINT16_MAX)};
    case Command::ReadLogicBattery:
        return Values{rounded(logicVoltage * tenths, 0, UINT16_MAX)};
    case Command::ReadTemperature:
    case Command::ReadTemperature2:
        return Values{rounded(temperature_ * tenths, 0, UINT16_MAX)};
    case Command::ReadBuffers:
        return Values{m1.queueLength(), m2.queueLength()};
    case Command::ReadPwm:
        return Values{std::llround(m1.duty() * fullDuty), std::llround(m2.duty() * fullDuty)};
    case Command::ReadCurrents:
        return Values{current(m1), current(m2)};
    case Command::ReadVelocityPidM1:
        return valuesOf(m1.pid());
    case Command::ReadVelocityPidM2:
        return valuesOf(m2.pid());
    default:
        return {};
    }
}

std::optional<Values> RoboClawEmulator::readStored(Command command, const Values &asked) const {
    const auto find = [this](std::uint32_t key, const Values &initially) {
        const auto found = stored_.find(key);
        return found == stored_.end() ? initially : found->second;
    };
    if (command == Command::ReadEeprom)
        return find(eepromKey(asked[0]), {0});
    if (command == Command::ReadEncoderModes || command == Command::ReadDefaultAccels) {
        const bool modes = command == Command::ReadEncoderModes;
        const Values m1 =
            find(std::uint32_t(modes ? Command::SetEncoderModeM1 : Command::SetDefaultAccelM1), {0});
        const Values m2 =
            find(std::uint32_t(modes ? Command::SetEncoderModeM2 : Command::SetDefaultAccelM2), {0});
        return Values{m1[0], m2[0]};
    }
    for (const Stored &entry : stored) {
        if (entry.read != command)
            continue;
        const Values v = find(std::uint32_t(entry.write), entry.initially);
        const bool positionPid = v.size() == 7; // set as D, P, I, told as P, I, D
        return positionPid ? Values{v[1], v[2], v[0], v[3], v[4], v[5], v[6]} : v;
    }
    return {};
}

} // namespace hermes
