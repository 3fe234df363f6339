#pragma once

#include "daemons/simulator/RoboClawEmulator.h"

#include <array>
#include <random>
#include <string>

namespace hermes::simulator {

/// A microcontroller with two motors as it looks from its serial line: the text protocol of ROS Arduino
/// Bridge, bytes in, answers out. Knows no line and no clock.
class ArduinoEmulator {
public:
    static constexpr int baud = 57600;
    static constexpr double frame = 0.033;         ///< seconds; speeds are in encoder counts in one
    static constexpr double restartTime = 2;       ///< seconds
    static constexpr std::size_t longestText = 15; ///< of a number in a command
    struct Options {
        double timeout = 2;  ///< seconds without a command that drives, then the power is off
        bool coasts = false; ///< its bridge lets the wheels roll without power; else it brakes them
        MotorChannel::Motor motor;
        std::uint64_t seed = 1; ///< of the faults
    };
    /// Those of a RoboClaw, as far as they fit; corrupt is the share of the bytes, both ways.
    using Faults = RoboClawEmulator::Faults;

    explicit ArduinoEmulator(const Options &options);

    /// One byte from the line; gives the answer, most often an empty one.
    RoboClawEmulator::Answer receive(char byte);
    /// Lets time pass. voltage: of the battery.
    void advance(double seconds, double voltage);
    /// As after a reset by DTR: it is dead for a while, then it answers with counts of 0.
    void restart();

    Faults &faults() { return faults_; }
    double timeout() const { return options_.timeout; }
    /// 0 on the left, 1 on the right.
    MotorChannel &channel(int motor) { return channels_[std::size_t(motor)]; }
    const MotorChannel &channel(int motor) const { return channels_[std::size_t(motor)]; }
    const RoboClawEmulator::Counts &counts() const { return counts_; }

private:
    enum class Mode { Off, Speed, Pwm };
    /// Of a command.
    struct Heard {
        char letter = 0;
        std::array<std::string, 2> texts; ///< of its numbers
        std::size_t blanks = 0;
    };

    std::string execute();
    void cutPower();
    char damaged(char byte);
    bool chance(double share) {
        return share > 0 && std::uniform_real_distribution<double>()(random_) < share;
    }

    Options options_;
    std::array<MotorChannel, 2> channels_;
    Faults faults_;
    RoboClawEmulator::Counts counts_;
    std::mt19937_64 random_;
    Heard heard_;
    Mode mode_ = Mode::Off;
    std::array<double, 2> speeds_{};                    ///< counts/s
    double silence_ = 0, frameLeft_ = 0, startsIn_ = 0; ///< seconds
};

} // namespace hermes::simulator
