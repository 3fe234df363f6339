#include "protocol/velodyne/PositionPacket.h"

#include <algorithm>
#include <cmath>

namespace hermes::velodyne {

namespace {

constexpr std::size_t chipsAt = 0x0E; // 8 bytes each
constexpr std::size_t stampAt = 0xC6;
constexpr std::size_t ppsAt = 0xCA;
constexpr std::size_t nmeaAt = 0xCE;

constexpr double gyroUnit_dps = 0.09766;
constexpr double temperatureUnit_c = 0.1453;
constexpr double temperatureZero_c = 25;
constexpr double accelUnit_g = 0.001221;

std::uint32_t word(const std::uint8_t *bytes) {
    return bytes[0] | std::uint32_t(bytes[1]) << 8;
}

/// The low 12 bits in two's complement.
int value12(const std::uint8_t *bytes) {
    const int value = int(word(bytes) & 0xFFF);
    return value < 0x800 ? value : value - 0x1000;
}

void setWord(std::uint8_t *bytes, std::uint32_t value) {
    bytes[0] = std::uint8_t(value);
    bytes[1] = std::uint8_t(value >> 8);
}

/// A value that is no number becomes 0.
void setValue12(std::uint8_t *bytes, double value) {
    const double limited = value >= -0x800 && value <= 0x7FF ? value
                           : value < 0                       ? -0x800
                           : value > 0                       ? 0x7FF
                                                             : 0;
    setWord(bytes, std::uint32_t(std::lround(limited)) & 0xFFF);
}

} // namespace

const char *toText(Pps pps) {
    switch (pps) {
    case Pps::Absent:
        return "absent";
    case Pps::Synchronizing:
        return "synchronizing";
    case Pps::Locked:
        return "locked";
    case Pps::Error:
        return "error";
    }
    return "unknown";
}

PositionFault decodePosition(const std::uint8_t *bytes, std::size_t size, PositionPacket &packet) {
    if (size != positionPacketSize)
        return PositionFault::Size;
    if (bytes[ppsAt] > std::uint8_t(Pps::Error))
        return PositionFault::Value;
    packet.stamp_us = (word(bytes + stampAt) | word(bytes + stampAt + 2) << 16) % stampPeriod_us;
    packet.pps = Pps(bytes[ppsAt]);
    for (std::size_t i = 0; i < packet.chips.size(); ++i) {
        const std::uint8_t *chip = bytes + chipsAt + 8 * i;
        packet.chips[i] = {value12(chip) * gyroUnit_dps,
                           value12(chip + 2) * temperatureUnit_c + temperatureZero_c,
                           value12(chip + 4) * accelUnit_g, value12(chip + 6) * accelUnit_g};
    }
    const std::uint8_t *text = bytes + nmeaAt;
    const auto isEnd = [](std::uint8_t byte) { return byte == 0 || byte == '\r' || byte == '\n'; };
    packet.nmea.assign(text, std::find_if(text, text + maximumNmea, isEnd));
    return PositionFault::None;
}

std::array<std::uint8_t, positionPacketSize> encodePosition(const PositionPacket &packet) {
    std::array<std::uint8_t, positionPacketSize> bytes{};
    for (std::size_t i = 0; i < packet.chips.size(); ++i) {
        std::uint8_t *chip = bytes.data() + chipsAt + 8 * i;
        setValue12(chip, packet.chips[i].gyro_dps / gyroUnit_dps);
        setValue12(chip + 2, (packet.chips[i].temperature_c - temperatureZero_c) / temperatureUnit_c);
        setValue12(chip + 4, packet.chips[i].accelX_g / accelUnit_g);
        setValue12(chip + 6, packet.chips[i].accelY_g / accelUnit_g);
    }
    setWord(bytes.data() + stampAt, packet.stamp_us & 0xFFFF);
    setWord(bytes.data() + stampAt + 2, packet.stamp_us >> 16);
    bytes[ppsAt] = std::uint8_t(packet.pps);
    if (!packet.nmea.empty() && packet.nmea.size() + 2 <= maximumNmea) {
        auto end = std::copy(packet.nmea.begin(), packet.nmea.end(), bytes.begin() + nmeaAt);
        *end++ = '\r';
        *end = '\n';
    }
    return bytes;
}

} // namespace hermes::velodyne
