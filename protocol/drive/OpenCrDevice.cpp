#include "protocol/drive/OpenCrDevice.h"

#include "protocol/drive/Crc16.h"

#include <algorithm>

namespace hermes::drive {

namespace {

namespace opencr {
enum Instruction : std::uint8_t { Read = 2, Write = 3, Status = 0x55 };
constexpr std::array<std::uint8_t, 5> packetStart{0xFF, 0xFF, 0xFD, 0x00, 0xC8}; // the last one is its id
constexpr std::size_t header = packetStart.size() + 2, shortestAnswer = 4; // instruction, error, checksum
constexpr std::uint16_t polynomial = 0x8005;
/// What is read of the table at once.
struct Part {
    std::uint16_t at;
    std::uint32_t size;
    const char *name;
};
constexpr Part state{14, 32, "14 (state)"}; // from debug mode to battery
constexpr Part positions{136, 8, "136 (positions)"};
constexpr Part motors{148, 2, "148 (motors)"}; // whether they were found, and their torque
constexpr std::uint16_t heartbeatAt = 19, velocityAt = 150;
constexpr std::size_t connected = 15 - state.at, battery = 42 - state.at;
constexpr double largest = 1e4; // hundredths: no number then holds FF FF FD, which would have to be stuffed

void pushLow(Bytes &bytes, std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i)
        bytes.push(std::uint8_t(value >> 8 * i));
}

void push(Bytes &bytes, Instruction instruction, std::uint16_t at, const Bytes &what) {
    Bytes packet;
    for (const std::uint8_t byte : packetStart)
        packet.push(byte);
    pushLow(packet, std::uint32_t(what.size() + 5), 2);
    packet.push(instruction);
    pushLow(packet, at, 2);
    packet.push(what);
    pushLow(packet, crc16<polynomial>(packet.data(), packet.size()), 2);
    bytes.push(packet);
}

std::uint32_t hundredths(double value) {
    return std::uint32_t(std::int32_t(std::lround(std::clamp(100 * value, -largest, largest))));
}

/// A step of the set-up as what it does. A stop comes first: it is connected then.
Command inStep(const Command &command) {
    using Kind = Command::Kind;
    constexpr Kind steps[] = {Kind::SetSpeeds, Kind::ReadSlow, Kind::ReadSlow, Kind::ReadEncoders,
                              Kind::ReadEncoders};
    return command.kind == Kind::SetUp ? Command{steps[command.number], command.number - 1} : command;
}

const Part &partOf(const Command &command) {
    return command.kind != Command::Kind::ReadSlow ? positions : command.number == 0 ? state : motors;
}
} // namespace opencr

} // namespace

bool OpenCrDevice::configure(const DeviceSettings &settings) {
    settings_ = settings;
    return false;
}

Bytes OpenCrDevice::bytes(const Command &asked) const {
    const Command command = opencr::inStep(asked);
    Bytes bytes, what;
    if (command.isSetPoint()) {
        const double metres = 2 * std::acos(-1.0) * settings_.wheelRadius_m / settings_.countsPerTurn;
        const double left = command.target()[0] * metres, right = command.target()[1] * metres;
        opencr::pushLow(what, opencr::hundredths((left + right) / 2), 4);
        for (int i = 0; i < 4; ++i) // y, z, and turns about x and y
            opencr::pushLow(what, 0, 4);
        opencr::pushLow(what, opencr::hundredths((right - left) / (2 * settings_.halfTrack_m)), 4);
        opencr::push(bytes, opencr::Write, opencr::velocityAt, what);
        what.clear();
        what.push(std::uint8_t(heartbeat_ + 1));
        opencr::push(bytes, opencr::Write, opencr::heartbeatAt, what);
        return bytes;
    }
    const opencr::Part &part = opencr::partOf(command);
    opencr::pushLow(what, part.size, 2);
    opencr::push(bytes, opencr::Read, part.at, what);
    return bytes;
}

MotorDevice::Name OpenCrDevice::nameOf(const Command &asked) const {
    const Command command = opencr::inStep(asked);
    return {command.isSetPoint() ? "150 (velocity)" : opencr::partOf(command).name};
}

void OpenCrDevice::begin(const Bytes &request) {
    received_ = place_ = asked_ = 0;
    awaited_ = 0;
    for (std::size_t at = 0; at + opencr::header < request.size(); at += opencr::header + request[at + 5]) {
        ++awaited_;
        if (request[at + 7] == opencr::Read)
            asked_ = request[at + 10];
        else if (request[at + 8] == opencr::heartbeatAt)
            heartbeat_ = request[at + 10];
    }
}

ReplyReader::Result OpenCrDevice::feed(std::uint8_t byte) {
    ++received_;
    const std::size_t at = place_++;
    if (at == 0)
        crc_ = 0, size_ = 0;
    if (at < opencr::header || at + 2 < opencr::header + size_)
        crc_ = crc16<opencr::polynomial>(&byte, 1, crc_);
    if (at < opencr::packetStart.size())
        return byte == opencr::packetStart[at] ? Result::Incomplete : Result::Unexpected;
    if (at < opencr::header) {
        size_ |= std::size_t(byte) << 8 * (at - opencr::packetStart.size());
        const bool fits = size_ >= opencr::shortestAnswer && size_ <= answer_.size();
        return at + 1 < opencr::header || fits ? Result::Incomplete : Result::Unexpected;
    }
    answer_[at - opencr::header] = byte;
    if (at + 1 < opencr::header + size_)
        return Result::Incomplete;
    place_ = 0;
    return crc_ == (answer_[size_ - 2] | answer_[size_ - 1] << 8) ? takeAnswer() : Result::BadCrc;
}

ReplyReader::Result OpenCrDevice::takeAnswer() {
    std::size_t size = 0; // without each FD that follows FF FF FD: it was stuffed
    bool isStuffing = false;
    for (std::size_t i = 0; i + 2 < size_; ++i) {
        isStuffing = !isStuffing && size >= 3 && answer_[i] == 0xFD && answer_[size - 1] == 0xFD &&
                     answer_[size - 2] == 0xFF && answer_[size - 3] == 0xFF;
        if (!isStuffing)
            answer_[size++] = answer_[i];
    }
    const bool isError = answer_[1] & 0x7F; // the highest bit tells of a motor's alert
    if (answer_[0] != opencr::Status || isError || size != asked_ + 2)
        return Result::Unexpected;
    return --awaited_ == 0 ? Result::Done : Result::Incomplete;
}

std::uint32_t OpenCrDevice::number(std::size_t at) const {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= std::uint32_t(answer_[2 + at + i]) << 8 * i;
    return value;
}

std::string OpenCrDevice::take(const Command &asked, Readings &readings) {
    const Command command = opencr::inStep(asked);
    if (command.kind != Command::Kind::ReadSlow)
        return {};
    const std::uint8_t *const told = answer_.data() + 2;
    if (command.number == 0) {
        readings.battery_v = number(opencr::battery) / 100.0;
        if (told[0] != 0)
            return "is in debug mode, in which it does not stop by itself (item 14)";
        if (asked.kind == Command::Kind::SetUp && told[opencr::connected] == 0)
            return "does not take the heartbeat (item 15): its firmware is not that for ROS 2";
        return {};
    }
    readings.complete = true;
    if (told[0] == 0)
        return "has not found its motors (item 148): see their power switch and their cable";
    return told[1] == 0 ? "has motors without torque (item 149): start it anew" : "";
}

} // namespace hermes::drive
