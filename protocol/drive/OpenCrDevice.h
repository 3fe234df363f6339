#pragma once

#include "protocol/drive/MotorDevice.h"

namespace hermes::drive {

/// The OpenCR of a TurtleBot 3 with its firmware for ROS 2: a table of bytes that is read and written in
/// packets of Dynamixel 2.0, little endian and with a checksum. It takes the velocity of the robot, and turns
/// its wheels itself: M1 is the left one, M2 the right one. (ROBOTIS-GIT/OpenCR, turtlebot3.cpp)
///
/// Its time-out is compiled in, and counts from the last CHANGE of a heartbeat, which goes out with each
/// set-point and never alone. Then, and when it is told to stand, it brakes by velocity control.
class OpenCrDevice : public SelfReadingDevice {
public:
    static constexpr int usualBaud = 115200;     ///< on USB any
    static constexpr double timeout_s = 0.5;     ///< HEARTBEAT_TIMEOUT_MS
    static constexpr double stepsPerMetre = 100; ///< of a speed; and per rad/s

    OpenCrDevice() { version_ = "OpenCR, TurtleBot 3"; }
    bool configure(const DeviceSettings &settings) override;
    DeviceTimeout timeout() const override { return {timeout_s, timeout_s, true}; }
    int setupSteps() const override { return 5; }
    int slowReadings() const override { return 2; }

    Bytes bytes(const Command &command) const override;
    Name nameOf(const Command &command) const override;
    std::string take(const Command &command, Readings &readings) override;
    std::array<std::uint32_t, 2> counts() const override { return {number(0), number(4)}; }

private:
    void begin(const Bytes &request) override;
    Result feed(std::uint8_t byte) override;
    Result takeAnswer();
    std::uint32_t number(std::size_t at) const;

    DeviceSettings settings_;
    std::uint8_t heartbeat_ = 0; // the last one that was sent

    int awaited_ = 0;       // answers
    std::size_t asked_ = 0; // bytes that are read
    std::size_t place_ = 0, size_ = 0;
    std::uint16_t crc_ = 0;
    std::array<std::uint8_t, 64> answer_{}; // from the instruction on
};

} // namespace hermes::drive
