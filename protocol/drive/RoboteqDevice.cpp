#include "protocol/drive/RoboteqDevice.h"

#include "protocol/drive/AnswerText.h"

#include <algorithm>
#include <utility>

namespace hermes::drive {

namespace {

namespace roboteq {
constexpr std::size_t longestText = 100;
/// A question that is answered by so many numbers; 0: by a text.
struct Question {
    const char *text;
    std::size_t numbers;
};
// ?FID, ~RWD and all commands are those of the fact sheet. From the Roboteq manual alone, with their units:
// ?V drive, battery and logic (0.1 V; the last one mV), ?A current of each motor (0.1 A), ?C absolute count
// of each encoder.
constexpr Question firmware{"?FID", 0}, counts{"?C", 2}, slow[] = {{"?V", 3}, {"?A", 2}, {"~RWD", 1}};

/// A step of the set-up, after the firmware. The time-out is read first, as it was written just before.
Command inStep(const Command &command) {
    if (command.kind != Command::Kind::SetUp || command.number == 0)
        return command;
    return command.number == 1 ? Command{Command::Kind::SetTimeout}
                               : Command{Command::Kind::ReadSlow, command.number % 3};
}
} // namespace roboteq

} // namespace

bool RoboteqDevice::configure(const DeviceSettings &settings) {
    largest_ = settings.pid.qpps;
    const int timeout_ms = std::max(1, int(1000 * std::min(settings.timeout_s, longestTimeout_s) + 1e-6));
    return std::exchange(timeout_ms_, timeout_ms) != timeout_ms;
}

std::string RoboteqDevice::textOf(const Command &asked) const {
    const Command command = roboteq::inStep(asked);
    const auto share = [&](std::size_t motor) {
        return std::to_string(
            std::lround(fullSpeed * std::clamp(command.target()[motor] / largest_, -1.0, 1.0)));
    };
    switch (command.kind) {
    case Command::Kind::SetSpeeds:
    case Command::Kind::CutPower:
        return "!G 1 " + share(0) + "\r!G 2 " + share(1);
    case Command::Kind::SetTimeout:
        return "^RWD " + std::to_string(timeout_ms_);
    case Command::Kind::ReadSlow:
        return roboteq::slow[command.number].text;
    case Command::Kind::SetUp:
        return roboteq::firmware.text;
    case Command::Kind::ReadEncoders:
        break;
    }
    return roboteq::counts.text;
}

Bytes RoboteqDevice::bytes(const Command &command) const {
    Bytes bytes;
    if (command.isSetPoint() &&
        command.target() == decltype(command.speeds){}) // what is left of a damaged line would take it in
        bytes.push('\r');
    bytes.push(textOf(command) + '\r');
    return bytes;
}

MotorDevice::Name RoboteqDevice::nameOf(const Command &command) const {
    const std::string text = textOf(command);
    return {text.substr(0, text.find(' '))};
}

void RoboteqDevice::begin(const Bytes &request) {
    request_.assign(reinterpret_cast<const char *>(request.data()), request.size());
    request_.erase(0, request_.find_first_not_of('\r'));
    awaited_ = std::count(request_.begin(), request_.end(), '\r');
    line_.clear();
    received_ = 0;
}

ReplyReader::Result RoboteqDevice::feed(std::uint8_t byte) {
    ++received_;
    if (byte != '\r' && byte != '\n') {
        line_.push_back(char(byte));
        return line_.size() > roboteq::longestText ? Result::Unexpected : Result::Incomplete;
    }
    const bool isAnswer = !line_.empty() && !isEcho();
    if (isAnswer && !takeLine())
        return Result::Unexpected;
    awaited_ -= isAnswer;
    line_.clear();
    return awaited_ == 0 ? Result::Done : Result::Incomplete;
}

bool RoboteqDevice::isEcho() const {
    return ('\r' + request_).find('\r' + line_ + '\r') != std::string::npos;
}

bool RoboteqDevice::takeLine() {
    if (request_[0] == '!' || request_[0] == '^')
        return line_ == "+";
    const std::string name = request_.substr(1, request_.size() - 2) + '=';
    if (line_.compare(0, name.size(), name) != 0)
        return false;
    const std::string_view text = std::string_view(line_).substr(name.size());
    if (request_[1] == roboteq::firmware.text[1]) {
        version_ = nameIn(text);
        return !version_.empty();
    }
    std::size_t expected = roboteq::counts.numbers;
    for (const roboteq::Question &question : roboteq::slow)
        if (question.text[1] == request_[1])
            expected = question.numbers;
    const auto numbers = numbersIn<3>(text, ':', expected);
    numbers_ = numbers.value_or(numbers_);
    return numbers.has_value();
}

std::string RoboteqDevice::take(const Command &asked, Readings &readings) {
    const Command command = roboteq::inStep(asked);
    if (command.kind != Command::Kind::ReadSlow)
        return {};
    const auto told = [this](std::size_t i) { return double(std::int32_t(numbers_[i])); };
    switch (command.number) {
    case 0:
        readings.battery_v = told(1) / 10;
        readings.logic_v = told(2) / 1000;
        return {};
    case 1:
        readings.current_a = {told(0) / 10, told(1) / 10};
        return {};
    default:
        readings.complete = true;
    }
    if (numbers_[0] == std::uint32_t(timeout_ms_))
        return {};
    return "has a time-out of " + std::to_string(std::int32_t(numbers_[0])) + " ms, expected the " +
           std::to_string(timeout_ms_) + " ms that were written";
}

} // namespace hermes::drive
