#include "daemons/simulator/ArduinoEmulator.h"

#include <algorithm>
#include <cstdlib>

namespace hermes::simulator {

namespace {

constexpr double largestPwm = 255;

} // namespace

ArduinoEmulator::ArduinoEmulator(const Options &options)
    : options_(options)
    , channels_{MotorChannel(options.motor), MotorChannel(options.motor)}
    , random_(options.seed) {
    MotorChannel::Pid pid;
    pid.qpps = options.motor.fullSpeed;
    for (MotorChannel &channel : channels_)
        channel.setPid(pid);
}

std::string ArduinoEmulator::receive(char byte) {
    if (isDead() || faults_.deaf)
        return {};
    std::string answer;
    for (const char heard : damaged({byte}))
        answer += hear(heard);
    return faults_.mute ? std::string() : damaged(answer);
}

std::string ArduinoEmulator::hear(char byte) {
    if (byte == '\r') {
        const std::string answer = execute() + "\r\n";
        heard_ = {};
        return answer;
    }
    if (byte == ' ') {
        heard_.blanks = std::min(heard_.blanks + 1, heard_.texts.size());
    } else if (heard_.blanks == 0) {
        heard_.letter = byte;
    } else {
        std::string &text = heard_.texts[heard_.blanks - 1];
        text += byte;
        if (text.size() > longestText) // beyond its memory: what that does is not known
            restart();
    }
    return {};
}

std::string ArduinoEmulator::execute() {
    const auto number = [this](std::size_t i) {
        return double(std::strtol(heard_.texts[i].c_str(), nullptr, 10));
    };
    ++counts_.requests;
    switch (heard_.letter) {
    case 'm':
        silence_ = 0;
        speeds_ = {number(0) / frame, number(1) / frame}; // from the next frame on
        if (speeds_[0] == 0 && speeds_[1] == 0)
            cutPower();
        else
            mode_ = Mode::Speed;
        return "OK";
    case 'o':
        silence_ = 0;
        mode_ = Mode::Pwm;
        for (const std::size_t i : {0, 1})
            channels_[i].driveDuty(number(i) / largestPwm);
        return "OK";
    case 'e':
        return std::to_string(count(0)) + ' ' + std::to_string(count(1));
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

std::string ArduinoEmulator::damaged(const std::string &bytes) {
    std::string left;
    for (const char byte : bytes) {
        if (!chance(faults_.loss))
            left += char(byte ^ (chance(faults_.corrupt) ? 1 << random_() % 8 : 0));
    }
    return left;
}

void ArduinoEmulator::advance(double seconds, double voltage) {
    silence_ += seconds;
    startsIn_ = std::max(0.0, startsIn_ - seconds);
    if (isDead())
        cutPower();
    if (mode_ != Mode::Off && silence_ >= options_.timeout && !faults_.stuckTimeout) {
        ++counts_.timeouts;
        cutPower();
    }
    frameLeft_ -= seconds;
    const bool begins = frameLeft_ <= 0;
    frameLeft_ = begins ? std::max(0.0, frameLeft_ + frame) : frameLeft_;
    for (std::size_t i = 0; i < channels_.size(); ++i) {
        MotorChannel &channel = channels_[i];
        if (begins && mode_ == Mode::Speed)
            channel.driveSpeed(speeds_[i]);
        channel.advance(seconds, voltage, !options_.coasts || mode_ == Mode::Speed || channel.target() != 0);
        if (startsIn_ > 0)
            channel.setCount(0);
    }
}

void ArduinoEmulator::restart() {
    cutPower();
    heard_ = {};
    startsIn_ = restartTime;
    ++counts_.restarts;
}

} // namespace hermes::simulator
