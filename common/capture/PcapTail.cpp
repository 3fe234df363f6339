#include "common/capture/PcapTail.h"

#include "common/capture/Frame.h"
#include "common/capture/PcapWriter.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace hermes {

namespace {

constexpr std::uint32_t nanoseconds = 1000000000;

std::uint32_t littleEndian(const std::uint8_t *bytes) {
    return bytes[0] | std::uint32_t(bytes[1]) << 8 | std::uint32_t(bytes[2]) << 16 |
           std::uint32_t(bytes[3]) << 24;
}

/// One record of a file; false when it is not whole or cannot be ours.
bool readRecord(std::FILE *file, std::array<std::uint8_t, frameHeaderSize + maximumPayload> &frame,
                std::uint32_t &length, Datagram &datagram) {
    std::uint8_t header[PcapWriter::recordHeaderBytes];
    if (std::fread(header, sizeof header, 1, file) != 1)
        return false;
    length = littleEndian(header + 8);
    const std::uint32_t fraction = littleEndian(header + 4);
    if (length < frameHeaderSize || length > frame.size() || length != littleEndian(header + 12) ||
        fraction >= nanoseconds || std::fread(frame.data(), length, 1, file) != 1)
        return false;
    datagram.stamp_ns = std::int64_t(littleEndian(header)) * nanoseconds + fraction;
    return parseFrame(LinkType::Ethernet, frame.data(), length, datagram) == FrameFault::None;
}

} // namespace

Outcome<PcapTail> readPcapTail(const std::string &path, std::uint64_t from,
                               const std::function<void(const Datagram &)> &sink) {
    PcapTail tail;
    const std::unique_ptr<std::FILE, int (*)(std::FILE *)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file || ::fseeko(file.get(), 0, SEEK_END) != 0) {
        return path + ": cannot be read: " + std::strerror(errno);
    }
    tail.fileBytes = std::uint64_t(::ftello(file.get()));
    if (tail.fileBytes < PcapWriter::fileHeaderBytes)
        return tail;
    std::uint8_t magic[4];
    std::rewind(file.get());
    if (std::fread(magic, sizeof magic, 1, file.get()) != 1 || littleEndian(magic) != PcapWriter::magic) {
        return path + ": it does not begin as a capture of nanoseconds";
    }
    const std::uint64_t first = PcapWriter::fileHeaderBytes;
    tail.wholeBytes = from > tail.fileBytes ? first : std::max(from, first);
    ::fseeko(file.get(), off_t(tail.wholeBytes), SEEK_SET);
    const auto frame = std::make_unique<std::array<std::uint8_t, frameHeaderSize + maximumPayload>>();
    Datagram datagram;
    std::uint32_t length = 0;
    while (readRecord(file.get(), *frame, length, datagram)) {
        tail.first_ns = tail.packets == 0 ? datagram.stamp_ns : tail.first_ns;
        tail.last_ns = datagram.stamp_ns;
        tail.wholeBytes += PcapWriter::recordHeaderBytes + length;
        ++tail.packets;
        sink(datagram);
    }
    return tail;
}

} // namespace hermes
