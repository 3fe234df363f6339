#pragma once

#include "daemons/simulator/MotorEmulator.h"

namespace hermes::simulator {

/// A microcontroller with two motors, 0 on the left, 1 on the right, that speaks the text protocol of ROS
/// Arduino Bridge.
class ArduinoEmulator : public MotorEmulator {
public:
    static constexpr int baud = 57600;
    static constexpr double frame = 0.033;         ///< seconds; speeds are in encoder counts in one
    static constexpr double restartTime = 2;       ///< seconds, after a reset by DTR
    static constexpr std::size_t longestText = 15; ///< of a number in a command
    struct Options : MotorEmulator::Options {
        double timeout = 2;  ///< seconds without a command that drives, then the power is off
        bool coasts = false; ///< its bridge lets the wheels roll without power; else it brakes them
    };

    explicit ArduinoEmulator(const Options &options)
        : MotorEmulator(options)
        , options_(options) {}

    double timeout() const override { return options_.timeout; }

private:
    enum class Mode { Off, Speed, Pwm };
    /// Of a command.
    struct Heard {
        char letter = 0;
        std::array<std::string, 2> texts; ///< of its numbers
        std::size_t blanks = 0;
    };

    void hear(std::uint8_t byte) override;
    void turn(double seconds) override;
    void reset() override;
    std::string execute();
    void cutPower();

    Options options_;
    Heard heard_;
    Mode mode_ = Mode::Off;
    std::array<double, 2> speeds_{}; ///< counts/s
    double frameLeft_ = 0;           ///< seconds
};

} // namespace hermes::simulator
