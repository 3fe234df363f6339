#include "daemons/simulator/VescEmulator.h"
#include "protocol/drive/Crc16.h"

#include <cstring>

namespace hermes::simulator {

namespace {

using Packed = std::vector<std::uint8_t>;

/// The fact sheet has no number for Alive. SET_APPCONF is not known here: the options set what it would.
struct VescCommand {
    enum : std::uint8_t {
        Firmware = 0x00,
        GetValues = 0x04,
        SetDuty = 0x05,
        SetCurrent = 0x06,
        SetBrake = 0x07,
        SetRpm = 0x08,
        SetServo = 0x0C,
        GetAppConf = 0x11,
        Alive = 0x1E,
        ForwardCan = 0x22,
        GetSelective = 0x32
    };
};
constexpr std::uint8_t shortStart = 2, longStart = 3, packetEnd = 3;
constexpr std::size_t longestPayload = 512;
// Of the app configuration: the fact sheet has neither.
constexpr std::size_t confSize = 400;
constexpr std::uint32_t confSignature = 0x5EC0DE01;
constexpr std::uint8_t nobody = 255; // as an id
constexpr double countsPerErpm = 6 / 60.0;

void appendBig(Packed &to, std::int64_t value, int size) {
    for (int shift = 8 * (size - 1); shift >= 0; shift -= 8)
        to.push_back(std::uint8_t(value >> shift));
}

std::uint32_t bigNumber(const Packed &from, std::size_t at, std::size_t size) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + size && i < from.size(); ++i)
        value = value << 8 | from[i];
    return value;
}

std::uint32_t bitsOf(double value) { // as a float
    const float single = float(value);
    std::uint32_t bits;
    std::memcpy(&bits, &single, sizeof bits);
    return bits;
}

} // namespace

void VescEmulator::hear(std::uint8_t byte) {
    received_.push_back(byte);
    while (auto payload = takePacket()) {
        std::size_t unit = 0;
        if (payload->size() > 2 && (*payload)[0] == VescCommand::ForwardCan) {
            unit = (*payload)[1] == options_.ids[1] && options_.ids[1] != nobody ? 1 : units_.size();
            payload->erase(payload->begin(), payload->begin() + 2);
        }
        if (unit < units_.size() && !payload->empty())
            execute(unit, *payload);
    }
}

std::optional<VescEmulator::Payload> VescEmulator::takePacket() {
    while (!received_.empty()) {
        const std::size_t head = received_[0] == longStart ? 3 : 2;
        if (received_[0] != shortStart && received_[0] != longStart) {
            received_.erase(received_.begin());
            continue;
        }
        if (received_.size() < head)
            return {};
        const std::size_t size = bigNumber(received_, 1, head - 1), whole = head + size + 3;
        if (size > 0 && size <= longestPayload && received_.size() < whole)
            return {};
        const bool fits = size > 0 && size <= longestPayload && received_[whole - 1] == packetEnd &&
                          bigNumber(received_, head + size, 2) == drive::crc16(&received_[head], size);
        if (fits) {
            const Payload payload(received_.begin() + long(head), received_.begin() + long(head + size));
            received_.erase(received_.begin(), received_.begin() + long(whole));
            return payload;
        }
        ++counts_.crcErrors;
        received_.erase(received_.begin()); // another one may begin within
    }
    return {};
}

void VescEmulator::execute(std::size_t number, const Payload &payload) {
    ++counts_.requests;
    if (set(number, payload))
        return;
    switch (payload[0]) {
    case VescCommand::Firmware: // what else it tells is not in the fact sheet
        return answer({VescCommand::Firmware, 7, 0, 's', 'i', 'm', 0});
    case VescCommand::GetValues:
        return answer(values(number, 0));
    case VescCommand::GetSelective:
        if (payload.size() >= 5)
            answer(values(number, bigNumber(payload, 1, 4)));
        return;
    case VescCommand::GetAppConf: {
        Payload conf{VescCommand::GetAppConf};
        appendBig(conf, confSignature, 4);
        appendBig(conf, options_.ids[number], 1);
        appendBig(conf, std::llround(options_.timeout * 1000), 4);
        appendBig(conf, bitsOf(options_.brakeCurrent), 4);
        conf.resize(confSize);
        return answer(conf);
    }
    default:
        --counts_.requests;
        ++counts_.unknown;
    }
}

bool VescEmulator::set(std::size_t number, const Payload &payload) {
    Unit &unit = units_[number];
    const auto value = double(std::int32_t(bigNumber(payload, 1, 4)));
    const auto take = [&](Mode mode, double wanted) {
        unit.silence = 0;
        unit.isLate = false;
        if (!faults_.latched)
            unit.mode = mode, unit.value = wanted;
        return true;
    };
    if (payload[0] == VescCommand::Alive || (payload[0] == VescCommand::SetServo && payload.size() == 3)) {
        if (payload[0] == VescCommand::SetServo)
            servo_ = std::clamp(double(std::int16_t(bigNumber(payload, 1, 2))) / 1000, 0.0, 1.0);
        return take(unit.mode, unit.value);
    }
    if (payload.size() != 5)
        return false;
    switch (payload[0]) {
    case VescCommand::SetDuty:
        return take(Mode::Duty, value / 1e5);
    case VescCommand::SetCurrent:
        return take(value == 0 ? Mode::Released : Mode::Current, value / 1000);
    case VescCommand::SetBrake:
        return take(Mode::Brake, std::abs(value) / 1000);
    case VescCommand::SetRpm:
        return take(std::abs(value) < leastErpm ? Mode::Released : Mode::Rpm, value * countsPerErpm);
    default:
        return false;
    }
}

VescEmulator::Payload VescEmulator::values(std::size_t number, std::uint32_t mask) const {
    const MotorChannel &motor = channels_[number];
    const auto rounded = [](double value) { return std::int64_t(std::llround(value)); };
    const std::int64_t motorA = rounded(motor.current() * 100), room = 250;
    Payload payload{mask ? VescCommand::GetSelective : VescCommand::GetValues};
    if (mask)
        appendBig(payload, mask, 4);
    int bit = 0;
    const auto add = [&](int size, std::initializer_list<std::int64_t> fields) {
        for (const std::int64_t field : fields) {
            if (!mask || mask >> bit & 1)
                appendBig(payload, field, size);
            ++bit;
        }
    };
    // Charge, energy, the way in both directions, faults and the position are not simulated.
    add(2, {room, room});
    add(4, {motorA, rounded(motor.current() * motor.duty() * 100), 0, motorA});
    add(2, {rounded(motor.duty() * 1000)});
    add(4, {rounded(motor.measuredSpeed() / countsPerErpm)});
    add(2, {rounded(voltage_ * 10)});
    add(4, {0, 0, 0, 0, motor.count(), 0});
    add(1, {0});
    add(4, {0});
    add(1, {options_.ids[number]});
    add(6, {room << 32 | room << 16 | room});
    add(4, {0, 0});
    add(1, {units_[number].isLate});
    return payload;
}

void VescEmulator::answer(const Payload &payload) {
    const bool isLong = payload.size() > 255;
    Payload packet{isLong ? longStart : shortStart};
    appendBig(packet, std::int64_t(payload.size()), isLong ? 2 : 1);
    packet.insert(packet.end(), payload.begin(), payload.end());
    appendBig(packet, drive::crc16(payload.data(), payload.size()), 2);
    packet.push_back(packetEnd);
    send(packet.data(), packet.size());
}

void VescEmulator::turn(double seconds) {
    for (std::size_t i = 0; i < units_.size(); ++i) {
        Unit &unit = units_[i];
        unit.silence += seconds;
        const bool isLate = options_.timeout > 0 && unit.silence >= options_.timeout && !faults_.stuckTimeout;
        counts_.timeouts += isLate && !unit.isLate && unit.mode != Mode::Released;
        if (isLate)
            unit.mode = options_.brakeCurrent > 0 ? Mode::Brake : Mode::Released,
            unit.value = options_.brakeCurrent;
        unit.isLate = isLate;
        if (isDead())
            unit.mode = Mode::Released;
        turnMotor(i, seconds);
    }
}

void VescEmulator::turnMotor(std::size_t number, double seconds) {
    const Unit &unit = units_[number];
    MotorChannel &motor = channels_[number];
    const bool isForce = unit.mode == Mode::Brake || unit.mode == Mode::Current;
    motor.setCurrentLimit(isForce ? std::abs(unit.value) : MotorChannel::unlimited);
    if (unit.mode == Mode::Rpm)
        motor.driveSpeed(unit.value);
    else if (unit.mode == Mode::Current) // so much duty that the limit is reached at any speed
        motor.driveDuty(std::copysign(1, unit.value));
    else
        motor.driveDuty(unit.mode == Mode::Duty ? unit.value : 0);
    motor.advance(seconds, voltage_, unit.mode != Mode::Released);
}

void VescEmulator::reset() {
    units_ = {};
    received_.clear();
    servo_.reset();
}

} // namespace hermes::simulator
