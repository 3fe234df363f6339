#pragma once

#include "common/Time.h"

#include <QtEndian>

#include <array>
#include <cstddef>

/// The index beside the raw bytes of a port: a header of 16 bytes, then a record of 24 bytes for each chunk
/// of bytes that came in together. A chunk ends where the next begins, the last with the file of bytes. A
/// record is written before its bytes: records that begin at or behind the end of the bytes count for
/// nothing.
namespace hermes::serialindex {

constexpr std::size_t headerSize = 16;
/// "HERMESIX", then the version and the size of a record, little endian.
constexpr std::array<unsigned char, headerSize> header = {'H', 'E', 'R', 'M', 'E', 'S', 'I', 'X',
                                                          1,   0,   0,   0,   24,  0,   0,   0};

/// Little endian on the disk, each 8 bytes: offset of the first byte, stamp_ns, mono_ns.
struct Record {
    std::uint64_t offset = 0;
    Moment arrival;
};
constexpr std::size_t recordSize = 24;

inline void encode(const Record &record, unsigned char *bytes) {
    qToLittleEndian<quint64>(record.offset, bytes);
    qToLittleEndian<qint64>(record.arrival.stamp_ns, bytes + 8);
    qToLittleEndian<qint64>(record.arrival.mono_ns, bytes + 16);
}

inline Record decode(const unsigned char *bytes) {
    return {qFromLittleEndian<quint64>(bytes),
            {qFromLittleEndian<qint64>(bytes + 8), qFromLittleEndian<qint64>(bytes + 16)}};
}

} // namespace hermes::serialindex
