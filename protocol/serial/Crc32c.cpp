#include "protocol/serial/Crc32c.h"

#include <array>

namespace hermes {
namespace {

constexpr quint32 polynomial = 0x82f63b78; // 0x1edc6f41, the lowest bit first
constexpr int slices = 4;                  // bytes taken at once
using Tables = std::array<std::array<quint32, 256>, slices>;

constexpr Tables makeTables() {
    Tables tables{};
    for (quint32 byte = 0; byte < 256; ++byte) {
        quint32 crc = byte;
        for (int bit = 0; bit < 8; ++bit)
            crc = crc & 1 ? crc >> 1 ^ polynomial : crc >> 1;
        tables[0][byte] = crc;
    }
    for (std::size_t slice = 1; slice < slices; ++slice)
        for (std::size_t byte = 0; byte < 256; ++byte) {
            const quint32 before = tables[slice - 1][byte];
            tables[slice][byte] = before >> 8 ^ tables[0][before & 0xff];
        }
    return tables;
}

constexpr Tables tables = makeTables();

} // namespace

quint32 crc32c(const void *bytes, std::size_t size) {
    const auto *at = static_cast<const quint8 *>(bytes);
    quint32 crc = 0xffffffff;
    for (; size >= slices; at += slices, size -= slices) {
        crc ^= quint32(at[0]) | quint32(at[1]) << 8 | quint32(at[2]) << 16 | quint32(at[3]) << 24;
        crc = tables[3][crc & 0xff] ^ tables[2][crc >> 8 & 0xff] ^ tables[1][crc >> 16 & 0xff] ^
              tables[0][crc >> 24];
    }
    for (; size > 0; ++at, --size)
        crc = crc >> 8 ^ tables[0][(crc ^ *at) & 0xff];
    return ~crc;
}

} // namespace hermes
