#pragma once

#include "protocol/drive/MotorDevice.h"
#include "protocol/roboclaw/Packet.h"

namespace hermes::roboclaw {

/// A RoboClaw as it is driven. Its set-up reads the version, writes and reads back the serial time-out and
/// the PID of both motors, and takes every slow reading once. The time-out is among these: a controller that
/// was without power for a moment has lost it, and would not stop by itself.
class Device : public drive::MotorDevice {
public:
    explicit Device(std::uint8_t address)
        : address_(address) {}

    bool configure(const drive::DeviceSettings &settings) override;
    drive::DeviceTimeout timeout() const override { return {timeoutTenths_ / 10.0, longestTimeout_s, false}; }
    int setupSteps() const override;
    int slowReadings() const override;
    bool isVital(const drive::Command &command) const override;

    drive::Bytes bytes(const drive::Command &command) const override { return request(command).bytes; }
    Name nameOf(const drive::Command &command) const override;
    drive::ReplyReader &reader() override { return parser_; }
    std::string take(const drive::Command &command, drive::Readings &readings) override;
    std::array<std::uint32_t, 2> counts() const override;
    /// "RoboClaw 2x45A v4.2.8"
    const std::string &version() const override { return version_; }

    static constexpr double longestTimeout_s = 0.5; ///< whatever the settings say

private:
    Request request(const drive::Command &command) const;
    Request setupRequest(int step) const;
    std::string setupFault(int step) const;
    std::string timeoutFault() const;
    std::string pidFault(int motor) const;
    std::string takeSlow(int reading, drive::Readings &readings) const;

    std::uint8_t address_;
    drive::VelocityPid pid_;
    int timeoutTenths_ = 2;
    ReplyParser parser_;
    std::string version_;
};

} // namespace hermes::roboclaw
