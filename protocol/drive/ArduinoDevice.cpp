#include "protocol/drive/ArduinoDevice.h"

#include "protocol/drive/AnswerText.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hermes::drive {

namespace {

constexpr std::size_t longestLine = 32;
constexpr long mostPerFrame = 32767; // its int has 16 bits

} // namespace

Bytes ArduinoDevice::bytes(const Command &command) const {
    std::string text = command.isSetPoint() ? "m" : "e";
    for (std::size_t i = 0; i < 2 && command.isSetPoint(); ++i)
        text += ' ' + std::to_string(std::clamp(std::lround(command.target()[i] / framesPerSecond),
                                                -mostPerFrame, mostPerFrame));
    Bytes bytes;
    if (!isClean_)
        bytes.push('\r');
    bytes.push(text); // short enough to need no heap
    bytes.push('\r');
    return bytes;
}

MotorDevice::Name ArduinoDevice::nameOf(const Command &command) const {
    return {command.isSetPoint() ? "m (speeds)" : "e (encoders)"};
}

void ArduinoDevice::begin(const Bytes &request) {
    flushes_ = request[0] == '\r';
    asksCounts_ = request[flushes_] == 'e';
    isClean_ = isAnswered_ = false;
    line_.clear();
    received_ = 0;
}

ReplyReader::Result ArduinoDevice::feed(std::uint8_t byte) {
    ++received_;
    if (byte != '\n') {
        if (byte != '\r')
            line_.push_back(char(byte));
        return line_.size() > longestLine ? Result::Unexpected : Result::Incomplete;
    }
    const bool isAnswer = takeLine();
    line_.clear();
    if (std::exchange(flushes_, false)) {
        isAnswered_ = isAnswer;
        return Result::Incomplete;
    }
    return isAnswer ? done() : Result::Unexpected;
}

// A firmware may leave an empty command without an answer.
ReplyReader::Result ArduinoDevice::silence() {
    return isAnswered_ && line_.empty() ? done() : Result::Incomplete;
}

ReplyReader::Result ArduinoDevice::done() {
    isClean_ = true;
    return Result::Done;
}

bool ArduinoDevice::takeLine() {
    if (!asksCounts_)
        return line_ == "OK";
    const auto counts = numbersIn<2>(line_, ' ');
    counts_ = counts.value_or(counts_);
    return counts.has_value();
}

} // namespace hermes::drive
