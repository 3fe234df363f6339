#include "protocol/roboclaw/Command.h"

#include <array>

namespace hermes::roboclaw {

namespace {

constexpr bool write = false, read = true;

// Fact sheet, section 3. Where firmware differs, the first layout is that of 4.1.29 to 4.2.
constexpr Layout layouts[] = {
    {Command::ForwardM1, write, "B"},
    {Command::BackwardM1, write, "B"},
    {Command::SetMainMinimumOld, write, "B"},
    {Command::SetMainMaximumOld, write, "B"},
    {Command::ForwardM2, write, "B"},
    {Command::BackwardM2, write, "B"},
    {Command::DriveM1, write, "B"},
    {Command::DriveM2, write, "B"},
    {Command::MixedForward, write, "B"},
    {Command::MixedBackward, write, "B"},
    {Command::MixedRight, write, "B"},
    {Command::MixedLeft, write, "B"},
    {Command::MixedDrive, write, "B"},
    {Command::MixedTurn, write, "B"},
    {Command::SetSerialTimeout, write, "B"},
    {Command::ReadSerialTimeout, read, "B"},
    {Command::ReadEncoderM1, read, "IB"},
    {Command::ReadEncoderM2, read, "IB"},
    {Command::ReadSpeedM1, read, "iB"},
    {Command::ReadSpeedM2, read, "iB"},
    {Command::ResetEncoders, write, ""},
    {Command::ReadVersion, read, "s"},
    {Command::SetEncoderM1, write, "I"},
    {Command::SetEncoderM2, write, "I"},
    {Command::ReadMainBattery, read, "H"},
    {Command::ReadLogicBattery, read, "H"},
    {Command::SetLogicMinimumOld, write, "B"},
    {Command::SetLogicMaximumOld, write, "B"},
    {Command::SetVelocityPidM1, write, "IIII"},
    {Command::SetVelocityPidM2, write, "IIII"},
    {Command::ReadRawSpeedM1, read, "iB"},
    {Command::ReadRawSpeedM2, read, "iB"},
    {Command::DutyM1, write, "h"},
    {Command::DutyM2, write, "h"},
    {Command::Duty, write, "hh"},
    {Command::SpeedM1, write, "i"},
    {Command::SpeedM2, write, "i"},
    {Command::Speed, write, "ii"},
    {Command::SpeedAccelM1, write, "Ii"},
    {Command::SpeedAccelM2, write, "Ii"},
    {Command::SpeedAccel, write, "Iii"},
    {Command::SpeedDistanceM1, write, "iIB"},
    {Command::SpeedDistanceM2, write, "iIB"},
    {Command::SpeedDistance, write, "iIiIB"},
    {Command::SpeedAccelDistanceM1, write, "IiIB"},
    {Command::SpeedAccelDistanceM2, write, "IiIB"},
    {Command::SpeedAccelDistance, write, "IiIiIB"},
    {Command::ReadBuffers, read, "BB"},
    {Command::ReadPwm, read, "hh"},
    {Command::ReadCurrents, read, "hh"},
    {Command::SpeedAccel2, write, "IiIi"},
    {Command::SpeedAccelDistance2, write, "IiIIiIB"},
    {Command::DutyAccelM1, write, "hI"},
    {Command::DutyAccelM2, write, "hI"},
    {Command::DutyAccel, write, "hIhI"},
    {Command::ReadVelocityPidM1, read, "IIII"},
    {Command::ReadVelocityPidM2, read, "IIII"},
    {Command::SetMainLimits, write, "HH", "HHB", ""},
    {Command::SetLogicLimits, write, "HH"},
    {Command::ReadMainLimits, read, "HH", "HHB", ""},
    {Command::ReadLogicLimits, read, "HH"},
    {Command::SetPositionPidM1, write, "IIIIIii"},
    {Command::SetPositionPidM2, write, "IIIIIii"},
    {Command::ReadPositionPidM1, read, "IIIIIii"},
    {Command::ReadPositionPidM2, read, "IIIIIii"},
    {Command::PositionM1, write, "IIIiB"},
    {Command::PositionM2, write, "IIIiB"},
    {Command::Position, write, "IIIiIIIiB"},
    {Command::SetDefaultAccelM1, write, "I", "II", ""},
    {Command::SetDefaultAccelM2, write, "I", "II", ""},
    {Command::SetDefaultSpeedM1, write, "H"},
    {Command::SetDefaultSpeedM2, write, "H"},
    {Command::ReadDefaultSpeeds, read, "HH"},
    {Command::SetPinModes, write, "BBB", "BBBBB", ""},
    {Command::ReadPinModes, read, "BBB"},
    {Command::SetDeadBand, write, "BB"},
    {Command::ReadDeadBand, read, "BB"},
    {Command::ReadEncoders, read, "II"},
    {Command::ReadRawSpeeds, read, "ii"},
    {Command::RestoreDefaults, write, "", "I", ""},
    {Command::ReadDefaultAccels, read, "II"},
    {Command::ReadTemperature, read, "H"},
    {Command::ReadTemperature2, read, "H"},
    {Command::ReadStatus, read, "I", "H", ""},
    {Command::ReadEncoderModes, read, "BB"},
    {Command::SetEncoderModeM1, write, "B"},
    {Command::SetEncoderModeM2, write, "B"},
    {Command::WriteSettings, write, "I"},
    {Command::ReloadSettings, write, ""},
    {Command::SetConfig, write, "H"},
    {Command::ReadConfig, read, "H"},
    {Command::SetOutputModes, write, "BB"},
    {Command::ReadOutputModes, read, "BB"},
    {Command::SetOutput1, write, "H"},
    {Command::SetOutput2, write, "H"},
    {Command::ReadOutputs, read, "HH"},
    {Command::SetHomingM1, write, "HI"},
    {Command::SetHomingM2, write, "HI"},
    {Command::ReadHoming, read, "HIHI"},
    {Command::ReadAverageSpeeds, read, "ii"},
    {Command::SetSpeedErrorLimits, write, "II"},
    {Command::ReadSpeedErrorLimits, read, "II"},
    {Command::SetPositionErrorLimits, write, "II"},
    {Command::ReadPositionErrorLimits, read, "II"},
    {Command::SetVoltageOffsets, write, "BB"},
    {Command::ReadVoltageOffsets, read, "BB"},
    {Command::SetCurrentBlanking, write, "HH"},
    {Command::ReadCurrentBlanking, read, "HH"},
    {Command::SetMaxCurrentM1, write, "II"},
    {Command::SetMaxCurrentM2, write, "II"},
    {Command::ReadMaxCurrentM1, read, "II"},
    {Command::ReadMaxCurrentM2, read, "II"},
    {Command::SetPwmMode, write, "B", "BB", ""},
    {Command::ReadPwmMode, read, "B"},
    {Command::ReadEeprom, read, "H", "B"},
    {Command::WriteEeprom, write, "BH"},
};

std::array<const Layout *, 256> makeIndex() {
    std::array<const Layout *, 256> index{};
    for (const Layout &layout : layouts)
        index[std::size_t(layout.command)] = &layout;
    return index;
}

} // namespace

const Layout *layoutOf(std::uint8_t command) {
    static const std::array<const Layout *, 256> index = makeIndex();
    return index[command];
}

std::size_t sizeOf(std::string_view fields) {
    std::size_t size = 0;
    for (const char field : fields)
        size += field == 'B' ? 1 : field == 'H' || field == 'h' ? 2 : 4;
    return size;
}

} // namespace hermes::roboclaw
