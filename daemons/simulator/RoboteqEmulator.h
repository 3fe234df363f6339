#pragma once

#include "daemons/simulator/MotorEmulator.h"

namespace hermes::simulator {

/// A Roboteq with two channels, of which the first one turns the left motor: lines of text, without
/// checksums.
class RoboteqEmulator : public MotorEmulator {
public:
    static constexpr int baud = 115200;
    struct Options : MotorEmulator::Options {
        double timeout = 1; ///< seconds, when it is switched on; 0: never
    };

    explicit RoboteqEmulator(const Options &options);

    double timeout() const override { return watchdog_ms_ / 1000; }

private:
    void hear(std::uint8_t byte) override;
    void turn(double seconds) override;
    void reset() override;
    std::string execute(const std::string &line);
    std::string query(const std::string &name, int channel) const;
    bool configure(const std::string &name, double value);

    Options options_;
    std::string line_;
    bool echoes_ = true, isLate_ = false;
    double watchdog_ms_;
    std::array<double, 2> targets_{}; ///< counts/s; kept while its time-out acts
};

} // namespace hermes::simulator
