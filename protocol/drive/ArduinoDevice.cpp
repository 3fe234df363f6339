#include "protocol/drive/ArduinoDevice.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

namespace hermes::drive {

namespace {

constexpr std::size_t longestLine = 32;
constexpr long mostPerFrame = 32767; // its int has 16 bits

bool takeInt(std::string_view &text, std::uint32_t &value) {
    std::int32_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc())
        return false;
    value = std::uint32_t(number);
    text.remove_prefix(std::size_t(end - text.data()));
    return true;
}

} // namespace

Bytes ArduinoDevice::bytes(const Command &command) const {
    char text[48] = "e\r";
    if (command.kind == Command::Kind::SetSpeeds || command.kind == Command::Kind::CutPower) {
        std::array<long, 2> perFrame{};
        for (std::size_t i = 0; i < 2; ++i)
            perFrame[i] =
                std::clamp(std::lround(command.speeds[i] / framesPerSecond), -mostPerFrame, mostPerFrame);
        std::snprintf(text, sizeof(text), "m %ld %ld\r", perFrame[0], perFrame[1]);
    }
    Bytes bytes;
    if (!isClean_)
        bytes.push('\r');
    for (const char *letter = text; *letter != 0; ++letter)
        bytes.push(std::uint8_t(*letter));
    return bytes;
}

MotorDevice::Name ArduinoDevice::nameOf(const Command &command) const {
    const bool moves = command.kind == Command::Kind::SetSpeeds || command.kind == Command::Kind::CutPower;
    return {moves ? "m (speeds)" : "e (encoders)"};
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
    std::string_view text = line_;
    std::array<std::uint32_t, 2> counts{};
    if (!takeInt(text, counts[0]) || text.empty() || text[0] != ' ')
        return false;
    text.remove_prefix(1);
    if (!takeInt(text, counts[1]) || !text.empty())
        return false;
    counts_ = counts;
    return true;
}

} // namespace hermes::drive
