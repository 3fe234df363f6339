#pragma once

#include "common/Outcome.h"
#include "common/capture/Frame.h"

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace hermes {

/// What stands in a file of PcapWriter from some byte on.
struct PcapTail {
    std::uint64_t packets = 0;
    std::uint64_t wholeBytes = 0; ///< where the last whole record ends
    std::uint64_t fileBytes = 0;
    std::int64_t first_ns = 0; ///< stamps of the first and last of the packets
    std::int64_t last_ns = 0;
};

/// Reads the records from a byte on where one begins, the first of the file where from is less than that of
/// the first; stops at the first that is not whole or not ours. sink sees each datagram, and gives whether to
/// go on. Fails on a link, and on what is no regular file.
Outcome<PcapTail> readPcapTail(const std::string &path, std::uint64_t from,
                               const std::function<bool(const Datagram &)> &sink);

/// Writes datagrams to a classic pcap file with nanosecond stamps, each in an Ethernet frame with made-up
/// link addresses. Not for several threads at once. After a write error the file is cut back to whole
/// records.
class PcapWriter {
public:
    static constexpr std::uint32_t magic = 0xA1B23C4D; ///< of little-endian files with nanoseconds
    static constexpr std::size_t fileHeaderBytes = 24;
    static constexpr std::size_t recordHeaderBytes = 16;

    PcapWriter() = default;
    ~PcapWriter() { close(); }
    PcapWriter(const PcapWriter &) = delete;
    PcapWriter &operator=(const PcapWriter &) = delete;

    /// Fails on an existing file unless overwrite; leaves nothing behind when it fails.
    Outcome<void> open(const std::string &path, bool overwrite = false);
    /// Collects the datagram and writes when enough are collected. Fails when the file is not open, the
    /// datagram is larger than UDP allows, or writing failed; the file is closed after a write error.
    Outcome<void> write(const Datagram &datagram);
    /// Writes what is collected.
    Outcome<void> flush();
    /// Flushes and closes. Fails when something could not be written.
    Outcome<void> close();

    bool isOpen() const { return file_ >= 0; }
    const std::string &path() const { return path_; }
    std::uint64_t packets() const { return writtenPackets_ + bufferedPackets_; }
    std::uint64_t bytes() const { return writtenBytes_ + buffer_.size(); }
    /// Of these, what the last flush or error left in the file.
    std::uint64_t writtenPackets() const { return writtenPackets_; }
    std::uint64_t writtenBytes() const { return writtenBytes_; }

private:
    Outcome<void> fail(const std::string &what);
    Outcome<void> sinceOpen() const {
        return error_.empty() ? Outcome<void>() : error_;
    } // what an earlier call failed by
    void append(const void *bytes, std::size_t size) {
        const auto *begin = static_cast<const std::uint8_t *>(bytes);
        buffer_.insert(buffer_.end(), begin, begin + size);
    }
    void appendLittleEndian(std::uint32_t value) {
        const std::uint8_t bytes[4] = {std::uint8_t(value), std::uint8_t(value >> 8),
                                       std::uint8_t(value >> 16), std::uint8_t(value >> 24)};
        append(bytes, sizeof bytes);
    }

    int file_ = -1;
    std::string path_;
    std::string error_; // that ended writing
    std::vector<std::uint8_t> buffer_;
    std::uint64_t writtenPackets_ = 0;
    std::uint64_t writtenBytes_ = 0;
    std::uint64_t bufferedPackets_ = 0;
};

} // namespace hermes
