#include "protocol/roboclaw/Status.h"

namespace hermes::roboclaw {

namespace {

struct Meaning {
    std::uint32_t bit;
    std::uint16_t old; ///< 0: the old layout does not know it
    const char *text;
};

// Fact sheet, section 4.
constexpr Meaning meanings[] = {
    {EmergencyStop, 0x0004, "emergency stop"},
    {TemperatureError, 0x0008, "temperature too high"},
    {Temperature2Error, 0x0010, "temperature 2 too high"},
    {MainVoltageHighError, 0x0020, "main voltage too high"},
    {LogicVoltageHighError, 0x0040, "logic voltage too high"},
    {LogicVoltageLowError, 0x0080, "logic voltage too low"},
    {DriverFaultM1, 0x0100, "driver fault of motor 1"},
    {DriverFaultM2, 0x0200, "driver fault of motor 2"},
    {SpeedErrorM1, 0, "speed error of motor 1"},
    {SpeedErrorM2, 0, "speed error of motor 2"},
    {PositionErrorM1, 0, "position error of motor 1"},
    {PositionErrorM2, 0, "position error of motor 2"},
    {CurrentErrorM1, 0, "current error of motor 1"},
    {CurrentErrorM2, 0, "current error of motor 2"},
    {MainVoltageLowError, 0, "main voltage too low, motors roll freely"},
    {MainVoltageHighBraking, 0, "main voltage too high, motors brake"},
    {OverCurrentWarningM1, 0x0001, "over-current of motor 1"},
    {OverCurrentWarningM2, 0x0002, "over-current of motor 2"},
    {MainVoltageHighWarning, 0x0400, "main voltage high"},
    {MainVoltageLowWarning, 0x0800, "main voltage low"},
    {TemperatureWarning, 0x1000, "temperature high"},
    {Temperature2Warning, 0x2000, "temperature 2 high"},
    {SignalS4, 0, "signal at S4"},
    {SignalS5, 0, "signal at S5"},
};

} // namespace

std::uint32_t statusOf(const Reply &reply, Dialect dialect) {
    if (dialect == Dialect::Usual)
        return std::uint32_t(reply[0]);
    std::uint32_t status = 0;
    for (const Meaning &meaning : meanings)
        status |= reply[0] & meaning.old ? meaning.bit : 0;
    return status;
}

std::uint16_t oldStatusOf(std::uint32_t status) {
    std::uint16_t old = 0;
    for (const Meaning &meaning : meanings)
        old = std::uint16_t(old | (status & meaning.bit ? meaning.old : 0));
    return old;
}

const char *statusText(std::uint32_t bit) {
    for (const Meaning &meaning : meanings) {
        if (meaning.bit == bit)
            return meaning.text;
    }
    return "reserved bit";
}

} // namespace hermes::roboclaw
