#pragma once

#include "protocol/roboclaw/Bus.h"

#include <QtGlobal>
#include <array>
#include <optional>

namespace hermes::motorcontrol {

/// What a controller has told last. Beside the encoders, which are read in every cycle, there are slow
/// readings, one of which is read in a cycle.
struct ControllerReadings {
    static constexpr int slowCount = 7;
    /// Which command reads a slow one. The serial time-out is among them: a controller that was without power
    /// for a moment has lost it, and would not stop by itself.
    static constexpr roboclaw::Command slowCommand(int slow) {
        using roboclaw::Command;
        constexpr Command commands[slowCount] = {Command::ReadStatus,       Command::ReadCurrents,
                                                 Command::ReadPwm,          Command::ReadMainBattery,
                                                 Command::ReadTemperature,  Command::ReadLogicBattery,
                                                 Command::ReadSerialTimeout};
        return commands[slow];
    }
    /// Without it nothing is driven. Only the gauge of the battery needs the others.
    static constexpr bool isVital(int slow) { return slowCommand(slow) != roboclaw::Command::ReadPwm; }
    void takeSlow(int slow, const roboclaw::Bus::Outcome &outcome);

    std::array<quint32, 2> counts{}; ///< of the encoders of M1 and M2, modulo 2^32
    double countsTime = 0;           ///< monotonic; 0: none since it was set up
    double battery_v = 0, logic_v = 0;
    std::array<double, 2> current_a{};           ///< of M1 and M2
    std::optional<std::array<double, 2>> duty{}; ///< of M1 and M2, -1 to 1; nothing: it does not tell
    double temperature_c = 0;
    quint32 status = 0;       ///< bits of roboclaw::StatusBit
    qint64 timeoutTenths = 0; ///< of a second without a byte after which it stops
    bool complete = false;    ///< each vital one of the slow ones has been read since it was set up
    int setups = 0;           ///< times it was set up: it may have been without power in between
};

} // namespace hermes::motorcontrol
