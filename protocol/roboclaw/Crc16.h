#pragma once

#include <cstddef>
#include <cstdint>

namespace hermes::roboclaw {

/// CRC-16/XMODEM as RoboClaw uses it: polynomial 0x1021, not reflected, no final inversion. The check value
/// of "123456789" is 0x31C3. start: the CRC of the bytes before, to go on with.
constexpr std::uint16_t crc16(const std::uint8_t *data, std::size_t size, std::uint16_t start = 0) {
    std::uint16_t crc = start;
    for (std::size_t i = 0; i < size; ++i) {
        crc = std::uint16_t(crc ^ data[i] << 8);
        for (int bit = 0; bit < 8; ++bit)
            crc = std::uint16_t(crc & 0x8000 ? crc << 1 ^ 0x1021 : crc << 1);
    }
    return crc;
}

} // namespace hermes::roboclaw
