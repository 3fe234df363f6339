#include "common/capture/ClassicPcap.h"

#include <algorithm>

namespace hermes {

namespace {

constexpr std::uint32_t ofMicroseconds = 0xA1B2C3D4, ofNanoseconds = 0xA1B23C4D;
constexpr std::size_t fileHeaderBytes = 24, recordHeaderBytes = 16;

} // namespace

std::unique_ptr<CaptureRecords> ClassicPcap::open(std::istream &stream, const std::uint8_t *magic,
                                                  std::string &error) {
    std::unique_ptr<ClassicPcap> file(new ClassicPcap(stream));
    const auto isOneOfOurs = [&] {
        const std::uint32_t number = file->word(magic);
        file->hasMicroseconds_ = number == ofMicroseconds;
        return number == ofMicroseconds || number == ofNanoseconds;
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
    if (version != 2) {
        error = "version " + std::to_string(version) + '.' + std::to_string(part) + ", expected 2.4";
        return nullptr;
    }
    file->isOld_ = part < 4;
    file->linkType_ = int(file->word(header + 16) & 0xFFFF); // above it: checksums of the link layer
    file->offset_ = fileHeaderBytes;
    return file;
}

CaptureRecords::Next ClassicPcap::next(CaptureRecord &record) {
    std::uint8_t header[recordHeaderBytes];
    bool atEnd = false;
    if (!read(header, sizeof header, "a record's header", atEnd))
        return atEnd ? Next::End : Next::Failed;
    std::uint32_t length = word(header + 8);
    if (isOld_)
        length = std::min(length, word(header + 12));
    if (length > longestFrame)
        return fail("found a frame of " + std::to_string(length) + " bytes, expected at most " +
                    std::to_string(longestFrame));
    record.frame.resize(length);
    if (!read(record.frame.data(), length, "the frame"))
        return Next::Failed;
    record.linkType = linkType_;
    record.seconds = word(header);
    record.nanoseconds = std::int64_t(word(header + 4)) * (hasMicroseconds_ ? 1000 : 1);
    offset_ += std::int64_t(recordHeaderBytes + length);
    return Next::Record;
}

} // namespace hermes
