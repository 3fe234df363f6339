#pragma once

#include "protocol/roboclaw/Bus.h"

#include <QtGlobal>
#include <array>

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
    void takeSlow(int slow, const roboclaw::Bus::Outcome &outcome);

    std::array<quint32, 2> counts{}; ///< of the encoders of M1 and M2, modulo 2^32
    double countsTime = 0;           ///< monotonic; 0: none since it was set up
    double battery_v = 0, logic_v = 0;
    std::array<double, 2> current_a{}, duty{}; ///< of M1 and M2; duty: -1 to 1
    double temperature_c = 0;
    quint32 status = 0;       ///< bits of roboclaw::StatusBit
    qint64 timeoutTenths = 0; ///< of a second without a byte after which it stops
    bool complete = false;    ///< each of the slow ones has been read since it was set up
    int setups = 0;           ///< times it was set up: it may have been without power in between
};

} // namespace hermes::motorcontrol
