#include "protocol/drive/VescDevice.h"

#include "protocol/drive/AnswerText.h"
#include "protocol/drive/Crc16.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace hermes::drive {

namespace {

namespace vesc {
constexpr std::uint8_t firmware = 0, brake = 7, speed = 8, servo = 12, appConfiguration = 17, byCan = 34,
                       values = 50;
// Which values: bit 0 temperature of the power stage, 2 current, 6 duty, 8 voltage, 13 tachometer, 15 fault,
// 17 id, which tells who answers. They come in this order, after code and mask.
constexpr std::uint32_t onlyId = 1 << 17, counts = onlyId | 1 << 13, measures = onlyId | 0x8145;
constexpr std::size_t firstValue = 5;
constexpr std::size_t longestAnswer = 1024; // an app configuration
constexpr double largestBrake_a = 1000;     // more shows that the configuration is laid out otherwise
constexpr double largestErpm = 1e9;         // of its 32 bits
constexpr const char *faults[] = {nullptr,        "voltage too high", "voltage too low",
                                  "driver fault", "current too high", "power stage too hot",
                                  "motor too hot"};
} // namespace vesc

} // namespace

bool VescDevice::configure(const DeviceSettings &settings) {
    const bool differs =
        settings.timeout_s != settings_.timeout_s || settings.mayLackTimeout != settings_.mayLackTimeout;
    settings_ = settings;
    if (version_.empty())
        timeout_s_ = settings.timeout_s;
    return differs;
}

DeviceTimeout VescDevice::timeout() const {
    return {timeout_s_, std::isinf(timeout_s_) ? 0 : longestTimeout_s, true, coasts_};
}

void VescDevice::push(Bytes &bytes, int motor, std::uint8_t code, std::uint32_t argument, int size) const {
    Bytes payload;
    if (motor == 1)
        payload.push16(std::uint16_t(vesc::byCan << 8 | second_));
    payload.push(code);
    for (int i = size - 1; i >= 0; --i)
        payload.push(std::uint8_t(argument >> 8 * i));
    bytes.push16(std::uint16_t(2 << 8 | payload.size()));
    bytes.push(payload);
    bytes.push16(crc16(payload.data(), payload.size()));
    bytes.push(3);
}

void VescDevice::pushSpeed(Bytes &bytes, int motor, double speed) const {
    const double erpm = std::clamp(speed * erpmPerCount, -vesc::largestErpm, vesc::largestErpm);
    if (std::abs(erpm) < std::max(1.0, settings_.leastErpm))
        push(bytes, motor, vesc::brake, std::uint32_t(std::lround(1000 * settings_.brake_a)), 4);
    else
        push(bytes, motor, vesc::speed, std::uint32_t(std::int32_t(erpm)), 4);
}

Bytes VescDevice::bytes(const Command &command) const {
    const bool isSetUp = command.kind == Command::Kind::SetUp;
    const int step = command.number;
    Bytes bytes;
    if (isSetUp && step < 2 * motors_) {
        push(bytes, step % motors_, step < motors_ ? vesc::firmware : vesc::appConfiguration);
        return bytes;
    }
    std::uint32_t mask = vesc::counts;
    if (command.isSetPoint()) {
        mask = vesc::onlyId;
        for (int motor = 0; motor < motors_; ++motor)
            pushSpeed(bytes, motor, command.target()[std::size_t(motor)]);
        if (command.servo && std::isfinite(*command.servo))
            push(bytes, 0, vesc::servo,
                 std::uint32_t(std::lround(1000 * std::clamp(*command.servo, 0.0, 1.0))), 2);
    } else if (command.kind == Command::Kind::ReadSlow || (isSetUp && step == 2 * motors_)) {
        mask = vesc::measures;
    }
    for (int motor = 0; motor < motors_; ++motor)
        push(bytes, motor, vesc::values, mask, 4);
    return bytes;
}

MotorDevice::Name VescDevice::nameOf(const Command &command) const {
    const bool isStep = command.kind == Command::Kind::SetUp && command.number < 2 * motors_;
    return {command.isSetPoint()       ? "8 (speeds)"
            : !isStep                  ? "50 (values)"
            : command.number < motors_ ? "0 (firmware)"
                                       : "17 (app configuration)",
            {},
            motors_ == 1
                ? ""
                : ", or its second VESC does not: controllers.N.address is the CAN id of that one, or 255"};
}

void VescDevice::begin(const Bytes &request) {
    received_ = place_ = 0;
    awaited_ = 0;
    for (std::size_t at = 0; at + 5 <= request.size(); at += request[at + 1] + 5u) {
        const bool isSecond = request[at + 2] == vesc::byCan;
        const std::size_t code = at + (isSecond ? 4 : 2);
        if (request[code] == vesc::brake || request[code] == vesc::speed || request[code] == vesc::servo)
            continue;
        code_ = request[code];
        awaited_ |= isSecond ? 2 : 1;
        mask_ = 0;
        for (std::size_t i = 1; code_ == vesc::values && i <= 4; ++i)
            mask_ = mask_ << 8 | request[code + i];
    }
}

ReplyReader::Result VescDevice::feed(std::uint8_t byte) {
    ++received_;
    const std::size_t at = place_++;
    if (at == 0) {
        header_ = byte; // 2 or 3: one or two bytes of size follow
        answer_.size = crc_ = 0;
        return byte == 2 || byte == 3 ? Result::Incomplete : Result::Unexpected;
    }
    if (at < header_) {
        answer_.size = answer_.size << 8 | byte;
        const bool fits = answer_.size > 0 && answer_.size <= vesc::longestAnswer;
        return at + 1 < header_ || fits ? Result::Incomplete : Result::Unexpected;
    }
    if (at == header_ + answer_.size + 2) {
        place_ = 0;
        return byte == 3 && crc_ == 0 ? takeAnswer() : Result::BadCrc;
    }
    crc_ = crc16(&byte, 1, crc_); // its own makes it 0
    if (at - header_ < std::min(answer_.size, answer_.bytes.size()))
        answer_.bytes[at - header_] = byte;
    return Result::Incomplete;
}

ReplyReader::Result VescDevice::takeAnswer() {
    const std::size_t size = answer_.size;
    bool isSecond = awaited_ == 2, fits = answer_.bytes[0] == code_;
    if (code_ == vesc::values) {
        const int values = mask_ == vesc::onlyId ? 1 : mask_ == vesc::counts ? 5 : 12;
        fits = fits && size == vesc::firstValue + std::size_t(values) && answer_.number(1) == mask_;
        isSecond = fits && answer_.bytes[size - 1] == second_;
    } else {
        fits = fits && size >= (code_ == vesc::firmware ? 3 : 14);
    }
    const unsigned bit = isSecond ? 2 : 1;
    if (!fits || !(awaited_ & bit)) // or both have one id
        return Result::Unexpected;
    answers_[isSecond] = answer_;
    awaited_ = std::uint8_t(awaited_ & ~bit);
    return awaited_ == 0 ? Result::Done : Result::Incomplete;
}

std::uint32_t VescDevice::Answer::number(std::size_t at, int count) const {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i)
        value = value << 8 | bytes[at + std::size_t(i)];
    return value;
}

std::array<std::uint32_t, 2> VescDevice::counts() const {
    return {answers_[0].number(vesc::firstValue), motors_ == 2 ? answers_[1].number(vesc::firstValue) : 0};
}

std::string VescDevice::take(const Command &command, Readings &readings) {
    const int step = command.number, motor = step % motors_;
    if (command.kind == Command::Kind::ReadSlow || step == 2 * motors_)
        takeValues(readings);
    else if (step >= motors_ && step < 2 * motors_)
        return takeTimeout(motor);
    if (command.kind == Command::Kind::ReadSlow || step >= motors_)
        return {};
    const Answer &told = answers_[std::size_t(motor)];
    const std::string_view name(reinterpret_cast<const char *>(told.bytes.data()),
                                std::min(told.size, told.bytes.size()));
    const std::string text = "VESC " + std::to_string(told.bytes[1]) + '.' + std::to_string(told.bytes[2]) +
                             ' ' + nameIn(name.substr(3));
    version_ = motor == 0 ? text : version_ + ", by CAN " + text;
    return {};
}

// The app configuration begins with signature, id, time-out in ms, and the current with which it then brakes.
std::string VescDevice::takeTimeout(int motor) {
    const Answer &told = answers_[std::size_t(motor)];
    const std::string who = motor == 0 ? "the VESC on the wire " : "the VESC on the CAN bus ";
    const int id = told.bytes[5];
    if (motors_ == 2 && (id == second_) != (motor == 1))
        return who + "has the id " + std::to_string(id) + "; controllers.N.address names " +
               std::to_string(second_);
    const std::uint32_t timeout_ms = told.number(6), bits = told.number(10);
    float brake = 0;
    std::memcpy(&brake, &bits, sizeof(brake));
    if (!(brake >= 0 && brake <= vesc::largestBrake_a))
        return who + "tells a time-out brake current that is none: its firmware lays out its app "
                     "configuration otherwise";
    const double seconds = timeout_ms > 0 ? timeout_ms / 1000.0 : std::numeric_limits<double>::infinity();
    timeout_s_ = motor == 0 ? seconds : std::max(timeout_s_, seconds);
    coasts_ = brake == 0 || (motor == 1 && coasts_);
    const bool isFine = timeout_ms > 0 ? seconds <= settings_.timeout_s + 1e-6 : settings_.mayLackTimeout;
    if (!isFine)
        return who +
               (timeout_ms > 0 ? "stops by itself only after " + std::to_string(timeout_ms) + " ms"
                               : "never stops by itself") +
               ": set App Settings, General, Timeout in VESC Tool to the " +
               std::to_string(std::lround(1000 * settings_.timeout_s)) +
               " ms that controllers.timeout_s promises" +
               (timeout_ms > 0 ? "" : ", or see safety.no_device_timeout");
    return {};
}

void VescDevice::takeValues(Readings &readings) const {
    std::array<double, 2> duty{};
    for (std::size_t motor = 0; motor < std::size_t(motors_); ++motor) {
        const Answer &told = answers_[motor];
        const double hot_c = told.half(vesc::firstValue) / 10,
                     battery_v = told.half(vesc::firstValue + 8) / 10;
        readings.temperature_c = motor == 0 ? hot_c : std::max(readings.temperature_c, hot_c);
        readings.battery_v = motor == 0 ? battery_v : std::min(readings.battery_v, battery_v);
        readings.current_a[motor] = std::int32_t(told.number(vesc::firstValue + 2)) / 100.0;
        duty[motor] = std::clamp(told.half(vesc::firstValue + 6) / 1000, -1.0, 1.0);
        const std::size_t fault = told.bytes[vesc::firstValue + 10];
        readings.faults[motor] =
            fault < std::size(vesc::faults) ? vesc::faults[fault] : "a fault that VESC Tool names";
    }
    readings.duty = duty;
    readings.complete = true;
}

} // namespace hermes::drive
