#pragma once

#include "protocol/drive/MotorDevice.h"

namespace hermes::drive {

/// An Arduino or ESP32 with the text protocol of ros_arduino_bridge: a letter, a blank, arguments, ended by
/// CR; each command is answered by one line. The line has no checksum: a damaged byte may be another command,
/// and only the encoders show it. It tells neither battery nor errors, and of a restart nothing but counts
/// that begin at 0.
///
/// Its time-out is compiled in, cannot be read, and is restarted by set-points alone. Then, and when it is
/// told to stand, it takes the power away: wheels brake as the H-bridge and the floor do.
class ArduinoDevice : public SelfReadingDevice {
public:
    static constexpr int usualBaud = 57600;
    static constexpr double timeout_s = 2;        ///< AUTO_STOP_INTERVAL
    static constexpr double framesPerSecond = 30; ///< PID_RATE; set-points are whole counts a frame

    ArduinoDevice() { version_ = "Arduino, text protocol"; }
    bool configure(const DeviceSettings &) override { return false; } // its gains are compiled in, too
    DeviceTimeout timeout() const override { return {timeout_s, timeout_s, true, true}; }
    int setupSteps() const override { return 3; } // encoders, to see how fast it answers
    int slowReadings() const override { return 0; }
    void forgetLine() override { isClean_ = false; }

    Bytes bytes(const Command &command) const override;
    Name nameOf(const Command &command) const override;
    std::string take(const Command &, Readings &) override { return {}; }
    std::array<std::uint32_t, 2> counts() const override { return counts_; }

private:
    void begin(const Bytes &request) override;
    Result feed(std::uint8_t byte) override;
    Result silence() override;
    bool takeLine();
    Result done();

    std::array<std::uint32_t, 2> counts_{};
    bool isClean_ = false; // a part of a command may lie in its buffer: it is ended first
    bool flushes_ = false, asksCounts_ = false;
    bool isAnswered_ = false; // by the line that answers the end of that part
    std::string line_;
};

} // namespace hermes::drive
