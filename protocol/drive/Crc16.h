#pragma once

#include <cstddef>
#include <cstdint>

namespace hermes::drive {

/// CRC of 16 bits, not reflected, no final inversion, from start: 0, or the CRC of the bytes before. With
/// 0x1021 it is CRC-16/XMODEM (RoboClaw, VESC; of "123456789" 0x31C3), with 0x8005 that of Dynamixel 2.0.
template <std::uint16_t polynomial = 0x1021>
constexpr std::uint16_t crc16(const std::uint8_t *data, std::size_t size, std::uint16_t start = 0) {
    std::uint16_t crc = start;
    for (std::size_t i = 0; i < size; ++i) {
        crc = std::uint16_t(crc ^ data[i] << 8);
        for (int bit = 0; bit < 8; ++bit)
            crc = std::uint16_t(crc & 0x8000 ? crc << 1 ^ polynomial : crc << 1);
    }
    return crc;
}

} // namespace hermes::drive
