#include "protocol/roboclaw/Command.h"

#include <array>
#include <optional>

namespace hermes::roboclaw {

namespace {

constexpr bool write = false, read = true;

/// Commands with numbers that follow each other look the same up to the last of them.
struct LayoutRange {
    Layout first;
    Command last;

    constexpr LayoutRange(Layout layout)
        : LayoutRange(layout, layout.command) {}
    constexpr LayoutRange(Layout layout, Command end)
        : first(layout)
        , last(end) {}
};

// Fact sheet, section 3. Where firmware differs, the first layout is that of 4.1.29 to 4.2.
constexpr LayoutRange ranges[] = {
    {{Command::ForwardM1, write, "B"}, Command::SetSerialTimeout},
    {{Command::ReadSerialTimeout, read, "B"}},
    {{Command::ReadEncoderM1, read, "IB"}, Command::ReadEncoderM2},
    {{Command::ReadSpeedM1, read, "iB"}, Command::ReadSpeedM2},
    {{Command::ResetEncoders, write, ""}},
    {{Command::ReadVersion, read, "s"}},
    {{Command::SetEncoderM1, write, "I"}, Command::SetEncoderM2},
    {{Command::ReadMainBattery, read, "H"}, Command::ReadLogicBattery},
    {{Command::SetLogicMinimumOld, write, "B"}, Command::SetLogicMaximumOld},
    {{Command::SetVelocityPidM1, write, "IIII"}, Command::SetVelocityPidM2},
    {{Command::ReadRawSpeedM1, read, "iB"}, Command::ReadRawSpeedM2},
    {{Command::DutyM1, write, "h"}, Command::DutyM2},
    {{Command::Duty, write, "hh"}},
    {{Command::SpeedM1, write, "i"}, Command::SpeedM2},
    {{Command::Speed, write, "ii"}},
    {{Command::SpeedAccelM1, write, "Ii"}, Command::SpeedAccelM2},
    {{Command::SpeedAccel, write, "Iii"}},
    {{Command::SpeedDistanceM1, write, "iIB"}, Command::SpeedDistanceM2},
    {{Command::SpeedDistance, write, "iIiIB"}},
    {{Command::SpeedAccelDistanceM1, write, "IiIB"}, Command::SpeedAccelDistanceM2},
    {{Command::SpeedAccelDistance, write, "IiIiIB"}},
    {{Command::ReadBuffers, read, "BB"}},
    {{Command::ReadPwm, read, "hh"}, Command::ReadCurrents},
    {{Command::SpeedAccel2, write, "IiIi"}},
    {{Command::SpeedAccelDistance2, write, "IiIIiIB"}},
    {{Command::DutyAccelM1, write, "hI"}, Command::DutyAccelM2},
    {{Command::DutyAccel, write, "hIhI"}},
    {{Command::ReadVelocityPidM1, read, "IIII"}, Command::ReadVelocityPidM2},
    {{Command::SetMainLimits, write, "HH", "HHB", ""}},
    {{Command::SetLogicLimits, write, "HH"}},
    {{Command::ReadMainLimits, read, "HH", "HHB", ""}},
    {{Command::ReadLogicLimits, read, "HH"}},
    {{Command::SetPositionPidM1, write, "IIIIIii"}, Command::SetPositionPidM2},
    {{Command::ReadPositionPidM1, read, "IIIIIii"}, Command::ReadPositionPidM2},
    {{Command::PositionM1, write, "IIIiB"}, Command::PositionM2},
    {{Command::Position, write, "IIIiIIIiB"}},
    {{Command::SetDefaultAccelM1, write, "I", "II", ""}, Command::SetDefaultAccelM2},
    {{Command::SetDefaultSpeedM1, write, "H"}, Command::SetDefaultSpeedM2},
    {{Command::ReadDefaultSpeeds, read, "HH"}},
    {{Command::SetPinModes, write, "BBB", "BBBBB", ""}},
    {{Command::ReadPinModes, read, "BBB"}},
    {{Command::SetDeadBand, write, "BB"}},
    {{Command::ReadDeadBand, read, "BB"}},
    {{Command::ReadEncoders, read, "II"}},
    {{Command::ReadRawSpeeds, read, "ii"}},
    {{Command::RestoreDefaults, write, "", "I", ""}},
    {{Command::ReadDefaultAccels, read, "II"}},
    {{Command::ReadTemperature, read, "H"}, Command::ReadTemperature2},
    {{Command::ReadStatus, read, "I", "H", ""}},
    {{Command::ReadEncoderModes, read, "BB"}},
    {{Command::SetEncoderModeM1, write, "B"}, Command::SetEncoderModeM2},
    {{Command::WriteSettings, write, "I"}},
    {{Command::ReloadSettings, write, ""}},
    {{Command::SetConfig, write, "H"}},
    {{Command::ReadConfig, read, "H"}},
    {{Command::SetOutputModes, write, "BB"}},
    {{Command::ReadOutputModes, read, "BB"}},
    {{Command::SetOutput1, write, "H"}, Command::SetOutput2},
    {{Command::ReadOutputs, read, "HH"}},
    {{Command::SetHomingM1, write, "HI"}, Command::SetHomingM2},
    {{Command::ReadHoming, read, "HIHI"}},
    {{Command::ReadAverageSpeeds, read, "ii"}},
    {{Command::SetSpeedErrorLimits, write, "II"}},
    {{Command::ReadSpeedErrorLimits, read, "II"}},
    {{Command::SetPositionErrorLimits, write, "II"}},
    {{Command::ReadPositionErrorLimits, read, "II"}},
    {{Command::SetVoltageOffsets, write, "BB"}},
    {{Command::ReadVoltageOffsets, read, "BB"}},
    {{Command::SetCurrentBlanking, write, "HH"}},
    {{Command::ReadCurrentBlanking, read, "HH"}},
    {{Command::SetMaxCurrentM1, write, "II"}, Command::SetMaxCurrentM2},
    {{Command::ReadMaxCurrentM1, read, "II"}, Command::ReadMaxCurrentM2},
    {{Command::SetPwmMode, write, "B", "BB", ""}},
    {{Command::ReadPwmMode, read, "B"}},
    {{Command::ReadEeprom, read, "H", "B"}},
    {{Command::WriteEeprom, write, "BH"}},
};

std::array<std::optional<Layout>, 256> makeIndex() {
    std::array<std::optional<Layout>, 256> index;
    for (const LayoutRange &range : ranges)
        for (std::size_t number = std::size_t(range.first.command); number <= std::size_t(range.last);
             ++number) {
            index[number] = range.first;
            index[number]->command = Command(number);
        }
    return index;
}

} // namespace

const Layout *layoutOf(std::uint8_t command) {
    static const std::array<std::optional<Layout>, 256> index = makeIndex();
    return index[command] ? &*index[command] : nullptr;
}

std::size_t sizeOf(std::string_view fields) {
    std::size_t size = 0;
    for (const char field : fields)
        size += field == 'B' ? 1 : field == 'H' || field == 'h' ? 2 : 4;
    return size;
}

} // namespace hermes::roboclaw
