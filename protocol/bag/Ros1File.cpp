#include "protocol/bag/Ros1File.h"

#include "protocol/bag/Bzip2.h"
#include "protocol/mcap/Contents.h"
#include "protocol/mcap/Unpack.h"

#include <algorithm>

namespace hermes::bag {

namespace {

constexpr std::uint64_t largestRos1Header = 64 << 10; // of a record
constexpr std::uint64_t largestRos1Ratio = 1 << 15;   // bz2: 900 kB of zeros take 45 bytes

} // namespace

std::string bytesText(std::uint64_t bytes) {
    return std::to_string(bytes) + " bytes";
}

std::uint64_t Ros1File::skipZeros(std::uint64_t offset) {
    std::string block;
    if (!read(offset, 4, block) || block != std::string(4, '\0'))
        return offset;
    for (constexpr std::uint64_t most = 1 << 16; offset < size(); offset += block.size()) {
        if (!read(offset, std::min(most, size() - offset), block))
            return size();
        if (const std::size_t at = block.find_first_not_of('\0'); at != std::string::npos)
            return offset + at;
    }
    return offset;
}

bool Ros1File::readHead(std::uint64_t offset, Ros1Head &head) {
    std::string number;
    std::uint32_t bytes = 0, data = 0;
    std::uint8_t kind = 0;
    const auto readSize = [&](std::uint64_t at, std::uint32_t &value) {
        std::string_view left;
        return read(at, 4, number) && mcap::takeField(left = number, value);
    };
    if (offset > size() || !readSize(offset, bytes))
        return note(offset, "the record is cut off");
    if (bytes > largestRos1Header)
        return note(offset, "found a record with a header of " + bytesText(bytes) + ", expected at most " +
                                bytesText(largestRos1Header));
    if (!read(offset + 4, bytes, head.bytes) || !readSize(offset + 4 + bytes, data))
        return note(offset, "the record is cut off");
    if (!head.fields.read(head.bytes) || !head.fields.number("op", kind))
        return note(offset, "the header of the record is damaged: it has no field op");
    head.at = offset;
    head.op = Ros1Op(kind);
    head.dataAt = offset + 4 + bytes + 4;
    head.dataBytes = data;
    return true;
}

bool Ros1File::unpack(const Ros1Head &head, std::string &records) {
    const auto compression = head.fields.text("compression");
    std::uint32_t expected = 0;
    head.fields.number("size", expected);
    const std::uint64_t there = std::min(head.dataBytes, size() - head.dataAt);
    const bool isPlain = compression == "none";
    if (there < head.dataBytes)
        note(head.at,
             "the chunk is cut off: found " + bytesText(there) + " of its " + bytesText(head.dataBytes));
    if (there < head.dataBytes && !isPlain)
        return false;
    if (head.dataBytes > mcap::largestChunk || expected > mcap::largestChunk ||
        expected / largestRos1Ratio > there)
        return note(head.at, "found a chunk of " + bytesText(head.dataBytes) + " that were " +
                                 bytesText(expected) + ", expected at most " + bytesText(mcap::largestChunk));
    std::string packed;
    if (!read(head.dataAt, there, isPlain ? records : packed))
        return note(head.at, "the chunk cannot be read");
    if (isPlain)
        return true;
    if (compression != "bz2" && compression != "lz4")
        return note(head.at, "found a chunk with compression '" + std::string(compression.substr(0, 20)) +
                                 "', expected none, bz2 or lz4");
    records.resize(expected);
    if (const std::string why =
            compression == "bz2" ? unpackBzip2(packed, records) : mcap::unpackLz4(packed, records);
        !why.empty())
        return note(head.at, "the chunk cannot be unpacked: " + why);
    return records.size() == expected ||
           note(head.at, "the chunk has " + bytesText(records.size()) + ", and not " + bytesText(expected) +
                             " as it tells");
}

} // namespace hermes::bag
