#pragma once

#include "protocol/roboclaw/Packet.h"

#include <cstdint>

namespace hermes::roboclaw {

/// The bits of command 90 in the layout of 32 bits: low word errors, high word warnings. Bits above
/// MainVoltageLowWarning that sources disagree about have no name here.
enum StatusBit : std::uint32_t {
    EmergencyStop = 0x00000001,
    TemperatureError = 0x00000002,
    Temperature2Error = 0x00000004,
    MainVoltageHighError = 0x00000008,
    LogicVoltageHighError = 0x00000010,
    LogicVoltageLowError = 0x00000020,
    DriverFaultM1 = 0x00000040,
    DriverFaultM2 = 0x00000080,
    SpeedErrorM1 = 0x00000100,
    SpeedErrorM2 = 0x00000200,
    PositionErrorM1 = 0x00000400,
    PositionErrorM2 = 0x00000800,
    CurrentErrorM1 = 0x00001000,
    CurrentErrorM2 = 0x00002000,
    MainVoltageLowError = 0x00004000,
    MainVoltageHighBraking = 0x00008000,
    OverCurrentWarningM1 = 0x00010000,
    OverCurrentWarningM2 = 0x00020000,
    MainVoltageHighWarning = 0x00040000,
    MainVoltageLowWarning = 0x00080000,
    TemperatureWarning = 0x00100000,
    Temperature2Warning = 0x00200000,
    SignalS4 = 0x00400000,
    SignalS5 = 0x00800000,
};
constexpr std::uint32_t statusErrors = 0x0000FFFF;

/// The status that a reply to ReadStatus tells, in the layout of 32 bits whatever the firmware sent. The home
/// bits of the old layout are left out.
std::uint32_t statusOf(const Reply &reply, Dialect dialect);
/// The bits of 32 in the old layout of 16; those that it does not know are left out.
std::uint16_t oldStatusOf(std::uint32_t status);

/// What one bit means, for people, e.g. "main voltage low"; "reserved bit" where it has no name.
const char *statusText(std::uint32_t bit);

} // namespace hermes::roboclaw
