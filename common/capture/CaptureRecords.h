#pragma once

#include <cstdint>
#include <istream>
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
/// ClassicPcap.h tells.
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
    Next fail(std::string why);
    /// Does so, too, and gives false.
    bool refuse(std::string why);
    /// The longest frame where a file or an interface tells that as its limit.
    static std::uint32_t longestFrame(std::uint32_t told);

    std::uint32_t word(const std::uint8_t *bytes) const;
    std::uint16_t half(const std::uint8_t *bytes) const;

    std::istream &stream_;
    std::string error_;
    std::vector<int> linkTypes_;
    std::int64_t offset_ = 0;
    bool bigEndian_ = false;
};

} // namespace hermes
