#include "daemons/simulator/RoboClawEmulator.h"

#include <algorithm>
#include <cmath>

namespace hermes::simulator {

using namespace roboclaw;

namespace {

constexpr double fixedPoint = 65536; // of PID gains
constexpr double centiampere = 100;
constexpr double logicVoltage = 5;
constexpr double lowest = 6; // V, as the old commands for limits have it

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

/// Which command sets what a read tells; the values are in the same order but for the position PID. What the
/// answer has no place for is left out.
struct Stored {
    Command read;
    Command write;
    Values initially;
};
const Stored stored[] = {
    {Command::ReadMainLimits, Command::SetMainLimits, {60, 340, 0}},
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
    {Command::ReadDeadBand, Command::SetDeadBand, {25, 25}},
    {Command::ReadOutputModes, Command::SetOutputModes, {0, 0}},
    {Command::ReadVoltageOffsets, Command::SetVoltageOffsets, {0, 0}},
    {Command::ReadCurrentBlanking, Command::SetCurrentBlanking, {0, 0}},
};

/// What is set for each motor and told of both, the first values of each.
struct StoredPair {
    Command read;
    std::array<Command, 2> writes;
};
const StoredPair storedPairs[] = {
    {Command::ReadDefaultSpeeds, {Command::SetDefaultSpeedM1, Command::SetDefaultSpeedM2}},
    {Command::ReadDefaultAccels, {Command::SetDefaultAccelM1, Command::SetDefaultAccelM2}},
    {Command::ReadEncoderModes, {Command::SetEncoderModeM1, Command::SetEncoderModeM2}},
    {Command::ReadOutputs, {Command::SetOutput1, Command::SetOutput2}},
    {Command::ReadHoming, {Command::SetHomingM1, Command::SetHomingM2}},
};

Values cut(const Values &values, std::size_t size) {
    Values result;
    for (std::size_t i = 0; i < std::min(values.size(), size); ++i)
        result.push(values[i]);
    return result;
}

} // namespace

// What the emulator keeps and tells.

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
    case Command::WriteSettings: // what is set is kept at once, so that this and reloading change nothing
        return v[0] == writeSettingsKey;
    case Command::ReloadSettings:
        return true;
    case Command::RestoreDefaults:
        restoreDefaults();
        return true;
    case Command::SetMainMinimumOld:
        return setLimit(Command::SetMainLimits, Command::ReadMainLimits, 0, lowest + double(v[0]) / 5), true;
    case Command::SetMainMaximumOld:
        return setLimit(Command::SetMainLimits, Command::ReadMainLimits, 1, double(v[0]) / 5.12), true;
    case Command::SetLogicMinimumOld:
        return setLimit(Command::SetLogicLimits, Command::ReadLogicLimits, 0, lowest + double(v[0]) / 5),
               true;
    case Command::SetLogicMaximumOld:
        return setLimit(Command::SetLogicLimits, Command::ReadLogicLimits, 1, double(v[0]) / 5.12), true;
    case Command::WriteEeprom:
        stored_[eepromKey(v[0])] = {v[1]};
        return true;
    case Command::SetMaxCurrentM1:
        m1.setCurrentLimit(double(v[0]) / centiampere);
        break;
    case Command::SetMaxCurrentM2:
        m2.setCurrentLimit(double(v[0]) / centiampere);
        break;
    default:
        break;
    }
    stored_[std::uint32_t(request.command)] = v;
    return true;
}

void RoboClawEmulator::setLimit(Command write, Command read, std::size_t index, double volts) {
    const auto before = *readStored(read, {});
    Values limits;
    for (std::size_t i = 0; i < before.size(); ++i)
        limits.push(i == index ? rounded(volts * tenths, 0, UINT16_MAX) : before[i]);
    stored_[std::uint32_t(write)] = limits;
}

void RoboClawEmulator::restoreDefaults() {
    stored_.erase(stored_.begin(), stored_.lower_bound(eepromKey(0)));
    timeoutTenths_ = 0;
    for (MotorChannel &channel : channels_) {
        channel.setPid({});
        channel.setCurrentLimit(MotorChannel::unlimited);
    }
}

std::optional<Values> RoboClawEmulator::read(Command command) {
    auto &[m1, m2] = channels_;
    const auto count = [](const MotorChannel &m) { return std::int64_t(std::uint32_t(m.count())); };
    const auto backward = [](const MotorChannel &m) { return std::int64_t(m.measuredSpeed() < 0); };
    const auto current = [](const MotorChannel &m) {
        return rounded(m.current() * centiampere, INT16_MIN, INT16_MAX);
    };
    const auto offset = [this](std::size_t battery) {
        return std::int8_t((*readStored(Command::ReadVoltageOffsets, {}))[battery]);
    };
    switch (command) {
    case Command::ReadSerialTimeout:
        return Values{timeoutTenths_};
    case Command::ReadEncoderM1:
        return Values{count(m1), m1.takeWraps() | 2 * backward(m1)};
    case Command::ReadEncoderM2:
        return Values{count(m2), m2.takeWraps() | 2 * backward(m2)};
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
        return Values{rounded(voltage_ * tenths + offset(0), 0, UINT16_MAX)};
    case Command::ReadLogicBattery:
        return Values{rounded(logicVoltage * tenths + offset(1), 0, UINT16_MAX)};
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
    const Layout &layout = *layoutOf(std::uint8_t(command));
    const std::size_t size = (options_.dialect == Dialect::Usual ? layout.fields : layout.otherFields).size();
    for (const StoredPair &pair : storedPairs) {
        if (pair.read != command)
            continue;
        Values both;
        for (const Command write : pair.writes) {
            const Values one = find(std::uint32_t(write), {0, 0});
            for (std::size_t i = 0; i < size / 2; ++i)
                both.push(one[i]);
        }
        return both;
    }
    for (const Stored &entry : stored) {
        if (entry.read != command)
            continue;
        const Values v = find(std::uint32_t(entry.write), entry.initially);
        const bool positionPid = v.size() == 7; // set as D, P, I, told as P, I, D
        return positionPid ? Values{v[1], v[2], v[0], v[3], v[4], v[5], v[6]} : cut(v, size);
    }
    return {};
}

} // namespace hermes::simulator
