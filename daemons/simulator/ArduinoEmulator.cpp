#include "daemons/simulator/ArduinoEmulator.h"

#include <algorithm>
#include <cstdlib>

namespace hermes::simulator {

namespace {

constexpr double largestPwm = 255;

} // namespace

void ArduinoEmulator::hear(std::uint8_t received) {
    const char byte = char(noisy(received));
    if (byte == '\r') {
        const std::string text = execute() + "\r\n";
        heard_ = {};
        sendPlain(text);
    } else if (byte == ' ') {
        heard_.blanks = std::min(heard_.blanks + 1, heard_.texts.size());
    } else if (heard_.blanks == 0) {
        heard_.letter = byte;
    } else if (std::string &text = heard_.texts[heard_.blanks - 1]; text.size() < longestText) {
        text += byte;
    } else { // beyond its memory: what that does is not known
        restart(restartTime);
    }
}

std::string ArduinoEmulator::execute() {
    const auto number = [this](std::size_t i) {
        return double(std::strtol(heard_.texts[i].c_str(), nullptr, 10));
    };
    const auto count = [this](int motor) { // of 32 bits
        return std::to_string(std::int32_t(std::uint32_t(channel(motor).count())));
    };
    ++counts_.requests;
    switch (heard_.letter) {
    case 'm':
        silence_ = 0;
        mode_ = Mode::Speed;
        speeds_ = {number(0) / frame, number(1) / frame}; // from the next frame on
        if (speeds_[0] == 0 && speeds_[1] == 0)
            cutPower();
        return "OK";
    case 'o':
        silence_ = 0;
        mode_ = Mode::Pwm;
        for (const std::size_t i : {0, 1})
            channels_[i].driveDuty(number(i) / largestPwm);
        return "OK";
    case 'e':
        return count(0) + ' ' + count(1);
    case 'r':
        for (MotorChannel &channel : channels_)
            channel.setCount(0);
        return "OK";
    case 'u': // gains, without effect
        return "OK";
    case 'b':
        return std::to_string(baud);
    default:
        --counts_.requests;
        ++counts_.unknown;
        return "Invalid Command";
    }
}

void ArduinoEmulator::cutPower() {
    mode_ = Mode::Off;
    for (MotorChannel &channel : channels_)
        channel.stop();
}

void ArduinoEmulator::turn(double seconds) {
    const bool timedOut = mode_ != Mode::Off && silence_ >= options_.timeout && !faults_.stuckTimeout;
    counts_.timeouts += timedOut;
    if (timedOut || faults_.silent)
        cutPower();
    frameLeft_ -= seconds;
    const bool begins = frameLeft_ <= 0;
    frameLeft_ = begins ? std::max(0.0, frameLeft_ + frame) : frameLeft_;
    for (std::size_t i = 0; i < channels_.size(); ++i) {
        MotorChannel &motor = channels_[i];
        if (begins && mode_ == Mode::Speed)
            motor.driveSpeed(speeds_[i]);
        motor.advance(seconds, voltage_, !options_.coasts || mode_ == Mode::Speed || motor.target() != 0);
        if (startsIn_ > 0)
            motor.setCount(0);
    }
}

void ArduinoEmulator::reset() {
    mode_ = Mode::Off;
    heard_ = {};
}

} // namespace hermes::simulator
