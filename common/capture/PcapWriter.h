#pragma once

#include "common/Outcome.h"
#include "common/capture/Datagram.h"

#include <string>
#include <vector>

namespace hermes {

/// Writes datagrams to a classic pcap file with nanosecond stamps, each in an Ethernet frame with made-up
/// link addresses. Not for several threads at once. After a write error the file is cut back to whole
/// records.
class PcapWriter {
public:
    static constexpr std::uint32_t magic = 0xA1B23C4D; ///< of little-endian files with nanoseconds
    static constexpr std::size_t fileHeaderBytes = 24;
    static constexpr std::size_t recordHeaderBytes = 16;

    PcapWriter() = default;
    ~PcapWriter();
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
    Outcome<void> sinceOpen() const; // what an earlier call failed by
    void append(const void *bytes, std::size_t size);
    void appendLittleEndian(std::uint32_t value);

    int file_ = -1;
    std::string path_;
    std::string error_; // that ended writing
    std::vector<std::uint8_t> buffer_;
    std::uint64_t writtenPackets_ = 0;
    std::uint64_t writtenBytes_ = 0;
    std::uint64_t bufferedPackets_ = 0;
};

} // namespace hermes
