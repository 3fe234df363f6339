#include "daemons/simulator/OpenCrEmulator.h"
#include "protocol/drive/Crc16.h"
#include "vectorlib/geometry/Angle.h"

#include <cstring>

namespace hermes::simulator {

namespace {

/// Addresses; what is not in the fact sheet is 0, and the profiles are kept, without effect.
struct Item {
    enum : std::size_t {
        Clock = 10,
        Debug = 14,
        Connected = 15,
        Heartbeat = 19,
        Voltage = 42,
        Charge = 46,
        Gyro = 60,
        Orientation = 96,
        Currents = 120,
        Speeds = 128,
        Positions = 136,
        MotorsFound = 148,
        Torque = 149,
        VelocityX = 150,
        TurnRate = 170,
        Profiles = 174,
        End = 182
    };
};
struct Instruction {
    enum : std::uint8_t { Ping = 1, Read = 2, Write = 3, Status = 0x55 };
};
/// The numbers are those of the protocol's manual; the fact sheet has only that there is such a byte.
struct DynamixelError {
    enum : std::uint8_t { None = 0, Instruction = 2, Length = 5, Access = 7 };
};
constexpr std::array<std::uint8_t, 4> dynamixelHeader{0xFF, 0xFF, 0xFD, 0x00};
constexpr auto dynamixelCrc = drive::crc16<0x8005>;
constexpr std::size_t longestDynamixel = 256;                            // of a packet; a guess
constexpr double speedUnit = 0.229 / 60 * OpenCrEmulator::countsPerTurn; // counts/s: a guess, of its motors
constexpr double twistUnit = 0.01;                                       // m/s, rad/s

std::size_t dynamixelWord(const std::vector<std::uint8_t> &data, std::size_t at) {
    return std::size_t(data[at] | data[at + 1] << 8);
}

/// Ends with the header of a packet, which must not be within one.
bool endsAsHeader(const std::vector<std::uint8_t> &data, std::size_t from) {
    return data.size() >= from + 3 && std::equal(data.end() - 3, data.end(), dynamixelHeader.begin());
}

} // namespace

OpenCrEmulator::OpenCrEmulator(const Options &options)
    : MotorEmulator(options)
    , options_(options)
    , items_(Item::End) {
    items_[Item::MotorsFound] = items_[Item::Torque] = 1;
}

void OpenCrEmulator::hear(std::uint8_t byte) {
    received_.push_back(byte);
    while (const auto packet = takePacket())
        execute(*packet);
}

std::optional<OpenCrEmulator::Data> OpenCrEmulator::takePacket() {
    while (!received_.empty()) {
        const std::size_t known = std::min(received_.size(), dynamixelHeader.size());
        const bool begins =
            std::equal(dynamixelHeader.begin(), dynamixelHeader.begin() + long(known), received_.begin());
        const std::size_t size = received_.size() < 7 ? 3 : dynamixelWord(received_, 5), whole = 7 + size;
        const bool fits = begins && size >= 3 && whole <= longestDynamixel;
        if (fits && received_.size() < whole)
            return {};
        if (!fits || dynamixelWord(received_, whole - 2) != dynamixelCrc(received_.data(), whole - 2, 0)) {
            counts_.crcErrors += fits;
            received_.erase(received_.begin()); // another one may begin within
            continue;
        }
        const bool isForIt = received_[4] == id;
        Data packet;
        for (std::size_t i = 7; i < whole - 2; ++i) {
            packet.push_back(received_[i]);
            i += endsAsHeader(packet, 0) && received_[i + 1] == 0xFD; // stuffed
        }
        received_.erase(received_.begin(), received_.begin() + long(whole));
        if (isForIt)
            return packet;
    }
    return {};
}

void OpenCrEmulator::execute(const Data &packet) {
    ++counts_.requests;
    const std::size_t at = packet.size() < 3 ? Item::End : dynamixelWord(packet, 1);
    switch (packet[0]) {
    case Instruction::Ping: // its model and version are not in the fact sheet
        return answer(DynamixelError::None, {0, 0, 1});
    case Instruction::Read: {
        const std::size_t size = packet.size() == 5 ? dynamixelWord(packet, 3) : 0;
        if (size == 0)
            return answer(DynamixelError::Length);
        if (at + size > Item::End)
            return answer(DynamixelError::Access);
        refresh();
        return answer(DynamixelError::None, {items_.begin() + long(at), items_.begin() + long(at + size)});
    }
    case Instruction::Write:
        return answer(packet.size() < 4                               ? DynamixelError::Length
                      : write(at, {packet.begin() + 3, packet.end()}) ? DynamixelError::None
                                                                      : DynamixelError::Access);
    default:
        --counts_.requests;
        ++counts_.unknown;
        return answer(DynamixelError::Instruction);
    }
}

void OpenCrEmulator::answer(std::uint8_t error, const Data &told) {
    Data packet(dynamixelHeader.begin(), dynamixelHeader.end());
    packet.insert(packet.end(), {id, 0, 0, Instruction::Status, error});
    for (const std::uint8_t byte : told) {
        packet.push_back(byte);
        if (endsAsHeader(packet, 7))
            packet.push_back(0xFD);
    }
    const std::size_t size = packet.size() - 5;
    packet[5] = std::uint8_t(size);
    packet[6] = std::uint8_t(size >> 8);
    const std::uint16_t crc = dynamixelCrc(packet.data(), packet.size(), 0);
    packet.insert(packet.end(), {std::uint8_t(crc), std::uint8_t(crc >> 8)});
    send(packet.data(), packet.size());
}

bool OpenCrEmulator::write(std::size_t at, const Data &values) {
    const std::size_t end = at + values.size();
    const bool isCommand = at >= Item::Torque && end <= Item::End;
    if (!isCommand && !(values.size() == 1 && (at == Item::Heartbeat || at == Item::Debug)))
        return false;
    if (at == Item::Heartbeat && items_[Item::Heartbeat] != values[0]) {
        silence_ = 0;
        items_[Item::Connected] = 1;
    }
    if (faults_.latched && isCommand)
        return true;
    std::copy(values.begin(), values.end(), items_.begin() + long(at));
    return true;
}

template <typename Value>
void OpenCrEmulator::put(std::size_t at, Value value) {
    std::memcpy(&items_[at], &value, sizeof value); // little endian, as its own processor
}

void OpenCrEmulator::refresh() {
    put(Item::Clock, std::uint32_t(age_ * 1000));
    put(Item::Voltage, std::uint32_t(voltage_ * 100));
    put(Item::Charge, std::uint32_t(10000));
    put(Item::Gyro + 2 * sizeof(float), float(rate_));
    put(Item::Orientation, float(std::cos(turned_ / 2))); // a quaternion: the order is not in the fact sheet
    put(Item::Orientation + 3 * sizeof(float), float(std::sin(turned_ / 2)));
    for (std::size_t i = 0; i < channels_.size(); ++i) {
        const std::size_t at = i * sizeof(std::int32_t);
        put(Item::Currents + at, std::int32_t(channels_[i].current() * 1000));
        put(Item::Speeds + at, std::int32_t(std::lround(channels_[i].measuredSpeed() / speedUnit)));
        put(Item::Positions + at, std::int32_t(std::uint32_t(channels_[i].count())));
    }
}

double OpenCrEmulator::velocity(std::size_t at) const {
    std::int32_t value;
    std::memcpy(&value, &items_[at], sizeof value);
    return value * twistUnit;
}

void OpenCrEmulator::turn(double seconds) {
    age_ += seconds;
    const bool isLate = silence_ >= options_.timeout && !faults_.stuckTimeout && items_[Item::Debug] == 0;
    counts_.timeouts += isLate && items_[Item::Connected];
    if (isLate)
        items_[Item::Connected] = 0;
    if (isDead() || (!items_[Item::Connected] && items_[Item::Debug] == 0))
        std::fill_n(items_.begin() + Item::VelocityX, Item::Profiles - Item::VelocityX,
                    std::uint8_t(0)); // stands, braked
    const double countsPerMetre = countsPerTurn / (2 * vectorlib::pi * options_.wheelRadius);
    const double turning = velocity(Item::TurnRate) * options_.halfTrack;
    for (std::size_t i = 0; i < channels_.size(); ++i) {
        channels_[i].driveSpeed((velocity(Item::VelocityX) + (i == 0 ? -turning : turning)) * countsPerMetre);
        channels_[i].advance(seconds, voltage_, !isDead() && items_[Item::Torque] != 0);
    }
    rate_ = (channels_[1].speed() - channels_[0].speed()) / countsPerMetre / (2 * options_.halfTrack);
    turned_ += rate_ * seconds;
}

void OpenCrEmulator::reset() {
    std::fill(items_.begin(), items_.end(), std::uint8_t(0));
    items_[Item::MotorsFound] = items_[Item::Torque] = 1;
    received_.clear();
    age_ = turned_ = 0;
}

} // namespace hermes::simulator
