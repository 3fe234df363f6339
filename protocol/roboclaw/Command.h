#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace hermes::roboclaw {

/// The commands of packet serial by their numbers. Speeds are in encoder counts a second, accelerations in
/// counts/s^2, distances and positions in counts, duties +-32767 for +-100 %.
enum class Command : std::uint8_t {
    ForwardM1 = 0, ///< 0 to 13 are not acknowledged by some firmware (4.3.6): better use 34 and 37
    BackwardM1 = 1,
    SetMainMinimumOld = 2,
    SetMainMaximumOld = 3,
    ForwardM2 = 4,
    BackwardM2 = 5,
    DriveM1 = 6,
    DriveM2 = 7,
    MixedForward = 8,
    MixedBackward = 9,
    MixedRight = 10,
    MixedLeft = 11,
    MixedDrive = 12,
    MixedTurn = 13,
    SetSerialTimeout = 14, ///< tenths of a second without a byte until both motors stop
    ReadSerialTimeout = 15,
    ReadEncoderM1 = 16, ///< count, status bits
    ReadEncoderM2 = 17,
    ReadSpeedM1 = 18, ///< speed, 1 when backward; see signedSpeed()
    ReadSpeedM2 = 19,
    ResetEncoders = 20,
    ReadVersion = 21, ///< text
    SetEncoderM1 = 22,
    SetEncoderM2 = 23,
    ReadMainBattery = 24, ///< 0.1 V
    ReadLogicBattery = 25,
    SetLogicMinimumOld = 26,
    SetLogicMaximumOld = 27,
    SetVelocityPidM1 = 28, ///< D, P, I (times 65536), QPPS: another order than in the reply to 55
    SetVelocityPidM2 = 29,
    ReadRawSpeedM1 = 30,
    ReadRawSpeedM2 = 31,
    DutyM1 = 32,
    DutyM2 = 33,
    Duty = 34, ///< both
    SpeedM1 = 35,
    SpeedM2 = 36,
    Speed = 37, ///< both, at once
    SpeedAccelM1 = 38,
    SpeedAccelM2 = 39,
    SpeedAccel = 40, ///< acceleration, speed of M1, of M2
    SpeedDistanceM1 = 41,
    SpeedDistanceM2 = 42,
    SpeedDistance = 43,
    SpeedAccelDistanceM1 = 44,
    SpeedAccelDistanceM2 = 45,
    SpeedAccelDistance = 46,
    ReadBuffers = 47,
    ReadPwm = 48,
    ReadCurrents = 49, ///< 10 mA, both
    SpeedAccel2 = 50,  ///< acceleration and speed of M1, of M2
    SpeedAccelDistance2 = 51,
    DutyAccelM1 = 52,
    DutyAccelM2 = 53,
    DutyAccel = 54,
    ReadVelocityPidM1 = 55, ///< P, I, D (times 65536), QPPS
    ReadVelocityPidM2 = 56,
    SetMainLimits = 57,
    SetLogicLimits = 58,
    ReadMainLimits = 59,
    ReadLogicLimits = 60,
    SetPositionPidM1 = 61,
    SetPositionPidM2 = 62,
    ReadPositionPidM1 = 63,
    ReadPositionPidM2 = 64,
    PositionM1 = 65,
    PositionM2 = 66,
    Position = 67,
    SetDefaultAccelM1 = 68,
    SetDefaultAccelM2 = 69,
    SetDefaultSpeedM1 = 70,
    SetDefaultSpeedM2 = 71,
    ReadDefaultSpeeds = 72,
    SetPinModes = 74,
    ReadPinModes = 75,
    SetDeadBand = 76, ///< 0.1 %, backward and forward
    ReadDeadBand = 77,
    ReadEncoders = 78, ///< both counts
    ReadRawSpeeds = 79,
    RestoreDefaults = 80,
    ReadDefaultAccels = 81,
    ReadTemperature = 82, ///< 0.1 degree Celsius
    ReadTemperature2 = 83,
    ReadStatus = 90, ///< see Status.h
    ReadEncoderModes = 91,
    SetEncoderModeM1 = 92,
    SetEncoderModeM2 = 93,
    WriteSettings = 94, ///< to the EEPROM; writeSettingsKey
    ReloadSettings = 95,
    SetConfig = 98,
    ReadConfig = 99,
    SetOutputModes = 100, ///< of the outputs CTRL1 and CTRL2; 4.3.6 takes 100 and 101 for something else
    ReadOutputModes = 101,
    SetOutput1 = 102, ///< 0 to 65535 for 0 to 100 %
    SetOutput2 = 103,
    ReadOutputs = 104,
    SetHomingM1 = 105, ///< duty or share of QPPS, time-out in 1/300 s
    SetHomingM2 = 106,
    ReadHoming = 107, ///< of both motors; the manual's answer shows one
    ReadAverageSpeeds = 108,
    SetSpeedErrorLimits = 109,
    ReadSpeedErrorLimits = 110,
    SetPositionErrorLimits = 112,
    ReadPositionErrorLimits = 113,
    SetVoltageOffsets = 115, ///< 0.1 V, two's complement, of the main and the logic battery
    ReadVoltageOffsets = 116,
    SetCurrentBlanking = 117, ///< duty below which no current is told
    ReadCurrentBlanking = 118,
    SetMaxCurrentM1 = 133, ///< 10 mA; maximum, minimum (0)
    SetMaxCurrentM2 = 134,
    ReadMaxCurrentM1 = 135,
    ReadMaxCurrentM2 = 136,
    SetPwmMode = 148,
    ReadPwmMode = 149,
    ReadEeprom = 252,
    WriteEeprom = 253, ///< acknowledged twice: at once, and by eepromWritten
};

constexpr std::uint32_t writeSettingsKey = 0xE22EAB7A;
constexpr std::uint8_t eepromWritten = 0xAA;
constexpr std::uint8_t firstAddress = 0x80, lastAddress = 0x87;
/// Where a robot has its controllers unless its settings say otherwise; their addresses begin with the first.
constexpr const char *usualLine = "serial:///dev/ttyACM0?baud=115200";

/// How a command looks on the wire. Fields are letters as in Python's struct: B u8, H u16, h i16, I u32,
/// i i32, s text; all big endian.
struct Layout {
    Command command;
    bool isRead;                  ///< a read is answered by data and CRC, a write by one byte 0xFF
    std::string_view fields;      ///< of a write, or of the reply to a read
    std::string_view otherFields; ///< as another firmware has it; the same as fields where all agree
    std::string_view arguments;   ///< of a read: what follows the command

    constexpr Layout(Command number, bool read, std::string_view data, std::string_view argumentFields = {})
        : Layout(number, read, data, data, argumentFields) {}
    constexpr Layout(Command number, bool read, std::string_view data, std::string_view otherData,
                     std::string_view argumentFields)
        : command(number)
        , isRead(read)
        , fields(data)
        , otherFields(otherData)
        , arguments(argumentFields) {}
};

constexpr std::size_t maxText = 48; ///< of a version, with its LF and NUL

/// nullptr for a number that is no command.
const Layout *layoutOf(std::uint8_t command);

/// Bytes that the fields fill; not for text.
std::size_t sizeOf(std::string_view fields);

} // namespace hermes::roboclaw
