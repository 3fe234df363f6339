#pragma once

#include <algorithm>
#include <cstdint>
#include <istream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace hermes {

/// A record of a capture file as it stands there.
struct CaptureRecord {
    std::int64_t offset = 0; ///< where it begins in the file, bytes
    int linkType = 0;        ///< by tcpdump.org's registry
    std::int64_t seconds = 0;
    std::int64_t nanoseconds = 0; ///< beside the seconds; not checked
    std::vector<std::uint8_t> frame;
};

/// The records of a capture, in the order of the file: those that libpcap gives, but for what
/// ClassicPcap tells.
class CaptureRecords {
public:
    enum class Next { Record, End, Failed };
    static constexpr std::uint32_t usualLongestFrame = 262144;

    virtual ~CaptureRecords() = default;
    /// After Failed, error() tells why.
    virtual Next next(CaptureRecord &record) = 0;
    /// Those told so far: at least one.
    const std::vector<int> &linkTypes() const { return linkTypes_; }
    /// Whether reading can go on at the beginning of any record.
    virtual bool canSeek() const = 0;
    const std::string &error() const { return error_; }
    /// Where the next record is looked for, or that which failed begins; bytes.
    std::int64_t offset() const { return offset_; }
    /// Goes on there; false: the stream cannot.
    bool seek(std::int64_t offset);

    /// Reads the beginning of a pcap or pcapng; null: error tells why it is none. The stream must live as
    /// long.
    static std::unique_ptr<CaptureRecords> open(std::istream &stream, std::string &error);

protected:
    explicit CaptureRecords(std::istream &stream)
        : stream_(stream) {}
    /// False: not so many bytes are left, and error_ tells why; atEnd: none at all, which is no error.
    bool read(std::uint8_t *bytes, std::size_t size, const char *what, bool &atEnd);
    /// Here the end is an error, too.
    bool read(std::uint8_t *bytes, std::size_t size, const char *what);
    /// Keeps the message for error().
    Next fail(std::string why) {
        error_ = std::move(why);
        return Next::Failed;
    }
    /// Does so, too, and gives false.
    bool refuse(std::string why) {
        error_ = std::move(why);
        return false;
    }
    /// The longest frame where a file or an interface tells that as its limit.
    // As in libpcap: no limit, or one that is none, stands for the usual one.
    static std::uint32_t longestFrame(std::uint32_t told) {
        return told == 0 || told > std::uint32_t(std::numeric_limits<std::int32_t>::max()) ? usualLongestFrame
                                                                                           : told;
    }

    std::uint32_t word(const std::uint8_t *bytes) const {
        return bigEndian_ ? std::uint32_t(half(bytes)) << 16 | half(bytes + 2)
                          : std::uint32_t(half(bytes + 2)) << 16 | half(bytes);
    }
    std::uint16_t half(const std::uint8_t *bytes) const {
        return std::uint16_t(bigEndian_ ? bytes[0] << 8 | bytes[1] : bytes[1] << 8 | bytes[0]);
    }

    std::istream &stream_;
    std::string error_;
    std::vector<int> linkTypes_;
    std::int64_t offset_ = 0;
    bool bigEndian_ = false;
};

/// A pcap file of version 2, with stamps of microseconds or nanoseconds, in either byte order, or a
/// "modified" one of microseconds. Frames are cut at the file's limit; those over usualLongestFrame are taken
/// for damage. Stamps have no sign: they end in 2106. (libpcap takes them for negative from 2038 on, where
/// the byte order is that of the machine.)
class ClassicPcap : public CaptureRecords {
public:
    /// magic: the first four bytes, read already. Null, and no error: it is another format.
    static std::unique_ptr<CaptureRecords> open(std::istream &stream, const std::uint8_t *magic,
                                                std::string &error);

    Next next(CaptureRecord &record) override;
    bool canSeek() const override { return true; }

private:
    using CaptureRecords::CaptureRecords;

    std::size_t recordHeaderBytes_ = 16;
    std::uint32_t longest_ = usualLongestFrame;
    bool hasMicroseconds_ = false;
    bool isOld_ = false; ///< before version 2.4 some programs wrote the two lengths the other way round
};

} // namespace hermes
