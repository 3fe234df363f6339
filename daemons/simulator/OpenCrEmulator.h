#pragma once

#include "daemons/simulator/MotorEmulator.h"

namespace hermes::simulator {

/// An OpenCR board with the firmware of TurtleBot 3: Dynamixel 2.0, a table of items, and two wheels that it
/// turns as the velocity of the robot demands.
class OpenCrEmulator : public MotorEmulator {
public:
    static constexpr std::uint8_t id = 0xC8;
    static constexpr double countsPerTurn = 4096; ///< of a wheel
    struct Options : MotorEmulator::Options {
        double timeout = 0.5;                         ///< seconds since the heartbeat changed
        double wheelRadius = 0.033, halfTrack = 0.08; ///< metres, as the firmware has them
    };

    explicit OpenCrEmulator(const Options &options);

    double timeout() const override { return options_.timeout; }

private:
    using Data = std::vector<std::uint8_t>;

    void hear(std::uint8_t byte) override;
    void turn(double seconds) override;
    void reset() override;
    /// The next whole packet of what came, from its instruction on; nothing when there is none.
    std::optional<Data> takePacket();
    void execute(const Data &packet);
    void answer(std::uint8_t error, const Data &told = {});
    /// False: an item there can not be written.
    bool write(std::size_t at, const Data &values);
    void refresh();
    template <typename Value>
    void put(std::size_t at, Value value);
    double velocity(std::size_t at) const;

    Options options_;
    Data received_, items_;
    double age_ = 0, rate_ = 0, turned_ = 0; ///< s since the start, rad/s, rad
};

} // namespace hermes::simulator
