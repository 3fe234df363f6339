#pragma once

#include "daemons/simulator/MotorChannel.h"

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
    /// What it does wrong.
    struct Faults {
        bool silent = false;       ///< dead, motors off
        bool deaf = false;         ///< hears nothing; drives on until its own time-out
        bool mute = false;         ///< obeys, but does not answer
        bool stuckTimeout = false; ///< its own time-out does not work
        double loss = 0;           ///< share of the bytes that are lost, both ways
        double corrupt = 0;        ///< share of the bytes with one bit flipped, both ways
        double delay = 0;          ///< seconds by which each answer is late
    };
    struct Counts {
        std::uint64_t requests = 0; ///< carried out
        std::uint64_t unknown = 0;
        std::uint64_t timeouts = 0; ///< times that silence stopped the motors
        std::uint64_t restarts = 0;
    };

    ArduinoEmulator()
        : ArduinoEmulator(Options()) {}
    explicit ArduinoEmulator(const Options &options);

    /// One byte from the line; gives the answer, most often none.
    std::string receive(char byte);
    /// Lets time pass. voltage: of the battery.
    void advance(double seconds, double voltage);
    /// As after a reset by DTR: it is dead for a while, then it answers with counts of 0.
    void restart();

    Faults &faults() { return faults_; }
    double timeout() const { return options_.timeout; }
    /// 0 on the left, 1 on the right.
    MotorChannel &channel(int motor) { return channels_[std::size_t(motor)]; }
    const MotorChannel &channel(int motor) const { return channels_[std::size_t(motor)]; }
    /// As it tells it.
    std::int32_t count(int motor) const { return std::int32_t(std::uint32_t(channel(motor).count())); }
    const Counts &counts() const { return counts_; }

private:
    enum class Mode { Off, Speed, Pwm };
    /// Of a command.
    struct Heard {
        char letter = 0;
        std::array<std::string, 2> texts; ///< of its numbers
        std::size_t blanks = 0;
    };

    std::string hear(char byte);
    std::string execute();
    void cutPower();
    std::string damaged(const std::string &bytes);
    bool chance(double share) {
        return share > 0 && std::uniform_real_distribution<double>()(random_) < share;
    }
    bool isDead() const { return faults_.silent || startsIn_ > 0; }

    Options options_;
    std::array<MotorChannel, 2> channels_;
    Faults faults_;
    Counts counts_;
    std::mt19937_64 random_;
    Heard heard_;
    Mode mode_ = Mode::Off;
    std::array<double, 2> speeds_{};                    ///< counts/s
    double silence_ = 0, frameLeft_ = 0, startsIn_ = 0; ///< seconds
};

} // namespace hermes::simulator
