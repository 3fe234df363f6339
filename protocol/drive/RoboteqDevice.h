#pragma once

#include "protocol/drive/MotorDevice.h"

namespace hermes::drive {

/// A Roboteq with two channels in closed-loop speed mode: lines that end with CR, numbers in decimal, no
/// checksum. A command is answered by + or -, a question by NAME=value:value; where its echo is on, the line
/// itself comes before. A speed is told in thousandths of the largest one, which is pid.qpps here.
///
/// Its time-out is written and read back. Only lines with ! restart it, and the next one makes it go on with
/// the speed it had: so both channels are told to stand before all else, in one write.
class RoboteqDevice : public SelfReadingDevice {
public:
    static constexpr int usualBaud = 115200;
    static constexpr double usualTimeout_s = 1, longestTimeout_s = 0.5; ///< its own; that is driven
    static constexpr double fullSpeed = 1000;

    bool configure(const DeviceSettings &settings) override;
    DeviceTimeout timeout() const override { return {timeout_ms_ / 1000.0, usualTimeout_s, false}; }
    int setupSteps() const override { return 2 + slowReadings(); }
    int slowReadings() const override { return 3; }

    Bytes bytes(const Command &command) const override;
    Name nameOf(const Command &command) const override;
    std::string take(const Command &command, Readings &readings) override;
    std::array<std::uint32_t, 2> counts() const override { return {numbers_[0], numbers_[1]}; }

private:
    void begin(const Bytes &request) override;
    Result feed(std::uint8_t byte) override;
    std::string textOf(const Command &command) const;
    bool isEcho() const;
    bool takeLine();

    double largest_ = VelocityPid().qpps; // counts/s
    int timeout_ms_ = 200;

    std::string request_, line_;
    long awaited_ = 0; // lines
    std::array<std::uint32_t, 3> numbers_{};
};

} // namespace hermes::drive
