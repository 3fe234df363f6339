#pragma once

#include "daemons/simulator/MotorEmulator.h"

namespace hermes::simulator {

/// A pair of VESCs: the first one, which turns the left motor, on the wire, the second one on its CAN bus. A
/// count is a step of the tachometer, six in an electrical turn.
class VescEmulator : public MotorEmulator {
public:
    static constexpr int baud = 115200;
    static constexpr double leastErpm = 900; ///< a slower set-point releases the motor
    struct Options : MotorEmulator::Options {
        double timeout = 1;                      ///< seconds; 0: never
        double brakeCurrent = 0;                 ///< A, after the time-out; with 0 the motor coasts
        std::array<std::uint8_t, 2> ids{0, 128}; ///< the second one as controllers.1.address at first
    };

    explicit VescEmulator(const Options &options)
        : MotorEmulator(options)
        , options_(options) {}

    /// Of each of both, since a command that is for it.
    double timeout() const override { return options_.timeout; }
    std::optional<double> servo() const override { return servo_; }

private:
    enum class Mode { Released, Duty, Current, Brake, Rpm };
    using Payload = std::vector<std::uint8_t>;
    struct Unit {
        Mode mode = Mode::Released;
        double value = 0;    ///< a share, A, or counts/s
        double silence = 0;  ///< seconds since a command that resets its time-out
        bool isLate = false; ///< its time-out acts
    };

    void hear(std::uint8_t byte) override;
    void turn(double seconds) override;
    void reset() override;
    /// The next whole packet of what came; nothing when there is none.
    std::optional<Payload> takePacket();
    void execute(std::size_t number, const Payload &payload);
    bool set(std::size_t number, const Payload &payload);
    Payload values(std::size_t number, std::uint32_t mask) const;
    void turnMotor(std::size_t number, double seconds);
    void answer(const Payload &payload);

    Options options_;
    std::array<Unit, 2> units_;
    Payload received_;
    std::optional<double> servo_; ///< 0 to 1
};

} // namespace hermes::simulator
