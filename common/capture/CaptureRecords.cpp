#include "common/capture/CaptureRecords.h"

#include "common/capture/ClassicPcap.h"
#include "common/capture/Pcapng.h"

#include <cerrno>
#include <cstring>
#include <limits>

namespace hermes {

namespace {

std::string cutShort(std::size_t found, const char *what, std::size_t expected) {
    return "found " + std::to_string(found) + " bytes of " + what + ", expected " + std::to_string(expected);
}

} // namespace

std::unique_ptr<CaptureRecords> CaptureRecords::open(std::istream &stream, std::string &error) {
    std::uint8_t magic[4] = {};
    errno = 0;
    stream.read(reinterpret_cast<char *>(magic), sizeof magic);
    if (stream.bad() || stream.gcount() != sizeof magic) {
        error = stream.bad() && errno != 0 ? std::strerror(errno)
                                           : "found " + std::to_string(stream.gcount()) + " bytes";
        return nullptr;
    }
    if (std::unique_ptr<CaptureRecords> pcap = ClassicPcap::open(stream, magic, error);
        pcap || !error.empty())
        return pcap;
    return Pcapng::open(stream, magic, error);
}

bool CaptureRecords::seek(std::int64_t offset) {
    stream_.clear();
    offset_ = offset;
    return bool(stream_.seekg(std::streamoff(offset)));
}

bool CaptureRecords::read(std::uint8_t *bytes, std::size_t size, const char *what, bool &atEnd) {
    errno = 0;
    stream_.read(reinterpret_cast<char *>(bytes), std::streamsize(size));
    const auto found = std::size_t(stream_.gcount());
    if (found == size)
        return true;
    atEnd = found == 0 && !stream_.bad();
    if (stream_.bad())
        error_ = errno != 0 ? std::strerror(errno) : "the data ends or breaks off too early";
    else if (!atEnd)
        error_ = cutShort(found, what, size);
    return false;
}

bool CaptureRecords::read(std::uint8_t *bytes, std::size_t size, const char *what) {
    bool atEnd = false;
    const bool done = read(bytes, size, what, atEnd);
    if (atEnd)
        error_ = cutShort(0, what, size);
    return done;
}

CaptureRecords::Next CaptureRecords::fail(std::string why) {
    error_ = std::move(why);
    return Next::Failed;
}

bool CaptureRecords::refuse(std::string why) {
    error_ = std::move(why);
    return false;
}

// As in libpcap: no limit, or one that is none, stands for the usual one.
std::uint32_t CaptureRecords::longestFrame(std::uint32_t told) {
    return told == 0 || told > std::uint32_t(std::numeric_limits<std::int32_t>::max()) ? usualLongestFrame
                                                                                       : told;
}

std::uint16_t CaptureRecords::half(const std::uint8_t *bytes) const {
    return std::uint16_t(bigEndian_ ? bytes[0] << 8 | bytes[1] : bytes[1] << 8 | bytes[0]);
}

std::uint32_t CaptureRecords::word(const std::uint8_t *bytes) const {
    return bigEndian_ ? std::uint32_t(half(bytes)) << 16 | half(bytes + 2)
                      : std::uint32_t(half(bytes + 2)) << 16 | half(bytes);
}

} // namespace hermes
