#include "common/capture/CaptureRecords.h"
#include "common/capture/Pcapng.h"

#include <cerrno>
#include <cstring>

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

namespace {

constexpr std::uint32_t ofMicroseconds = 0xA1B2C3D4, ofNanoseconds = 0xA1B23C4D;
// As patched versions of libpcap wrote it: interface, protocol and kind stand behind the lengths of each
// record.
constexpr std::uint32_t modified = 0xA1B2CD34;
constexpr std::size_t fileHeaderBytes = 24, modifiedHeaderBytes = 24;
constexpr std::uint32_t modifiedFrameBytes = 14; // by which frames may be longer than the limit

} // namespace

std::unique_ptr<CaptureRecords> ClassicPcap::open(std::istream &stream, const std::uint8_t *magic,
                                                  std::string &error) {
    std::unique_ptr<ClassicPcap> file(new ClassicPcap(stream));
    bool isModified = false;
    const auto isOneOfOurs = [&] {
        const std::uint32_t number = file->word(magic);
        isModified = number == modified;
        file->hasMicroseconds_ = number == ofMicroseconds || isModified;
        return file->hasMicroseconds_ || number == ofNanoseconds;
    };
    if (!isOneOfOurs()) {
        file->bigEndian_ = true;
        if (!isOneOfOurs())
            return nullptr;
    }
    std::uint8_t header[fileHeaderBytes - 4];
    if (!file->read(header, sizeof header, "the file's header")) {
        error = file->error_;
        return nullptr;
    }
    const int version = file->half(header), part = file->half(header + 2);
    if (version != 2 || part > 4) {
        error = "version " + std::to_string(version) + '.' + std::to_string(part) + ", expected 2.4";
        return nullptr;
    }
    file->isOld_ = part < 4;
    file->longest_ = longestFrame(file->word(header + 12));
    if (isModified) {
        file->recordHeaderBytes_ = modifiedHeaderBytes;
        file->longest_ += modifiedFrameBytes;
    }
    file->linkTypes_ = {int(file->word(header + 16) & 0xFFFF)}; // above it: checksums of the link layer
    file->offset_ = fileHeaderBytes;
    return file;
}

CaptureRecords::Next ClassicPcap::next(CaptureRecord &record) {
    std::uint8_t header[modifiedHeaderBytes];
    bool atEnd = false;
    if (!read(header, recordHeaderBytes_, "a record's header", atEnd))
        return atEnd ? Next::End : Next::Failed;
    std::uint32_t length = word(header + 8);
    if (isOld_)
        length = std::min(length, word(header + 12));
    if (length > usualLongestFrame)
        return fail("found a frame of " + std::to_string(length) + " bytes, expected at most " +
                    std::to_string(usualLongestFrame));
    record.frame.resize(length);
    if (!read(record.frame.data(), length, "the frame"))
        return Next::Failed;
    record.frame.resize(std::min(length, longest_));
    record.offset = offset_;
    record.linkType = linkTypes_.front();
    record.seconds = word(header);
    record.nanoseconds = std::int64_t(word(header + 4)) * (hasMicroseconds_ ? 1000 : 1);
    offset_ += std::int64_t(recordHeaderBytes_ + length);
    return Next::Record;
}

} // namespace hermes
