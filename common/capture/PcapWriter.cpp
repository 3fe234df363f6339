#include "common/capture/PcapWriter.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <sys/stat.h>
#include <unistd.h>

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
                               const std::function<bool(const Datagram &)> &sink) {
    PcapTail tail;
    struct stat status {};
    const int number = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    const std::unique_ptr<std::FILE, int (*)(std::FILE *)> file(number < 0 ? nullptr : ::fdopen(number, "rb"),
                                                                &std::fclose);
    if (!file || ::fstat(number, &status) != 0)
        return path + ": cannot be read: " + (errno == ELOOP ? "it is a link" : std::strerror(errno));
    if (!S_ISREG(status.st_mode))
        return path + ": not a regular file";
    tail.fileBytes = std::uint64_t(status.st_size);
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
        if (!sink(datagram))
            break;
    }
    return tail;
}

namespace {

constexpr std::uint32_t version = 4u << 16 | 2; // 2.4, as two 16-bit words
constexpr std::uint32_t snapLength = 262144;    // the most that readers accept
constexpr std::size_t bufferSize = 256 * 1024;  // about a tenth of a second of an HDL-32E
constexpr std::int64_t second_ns = 1000000000;

} // namespace

Outcome<void> PcapWriter::open(const std::string &path, bool overwrite) {
    close();
    path_ = path;
    error_.clear();
    writtenPackets_ = writtenBytes_ = bufferedPackets_ = 0;
    buffer_.clear();
    buffer_.reserve(bufferSize + frameHeaderSize + 16 + maximumPayload);
    file_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | (overwrite ? O_TRUNC : O_EXCL),
                   0644); // appends: what somebody cuts stays missing
    if (file_ < 0) {
        error_ =
            path + ": cannot be created: " + (errno == EEXIST ? "it exists already" : std::strerror(errno));
        return error_;
    }
    for (const std::uint32_t field : {magic, version, 0u, 0u, snapLength, std::uint32_t(LinkType::Ethernet)})
        appendLittleEndian(field);
    const Outcome<void> written = flush();
    if (!written)
        ::unlink(path.c_str());
    return written;
}

Outcome<void> PcapWriter::write(const Datagram &datagram) {
    if (!isOpen()) {
        return error_.empty() ? "no capture file is open" : error_;
    }
    if (datagram.size > maximumPayload) {
        return path_ + ": a datagram of " + std::to_string(datagram.size) +
               " bytes is larger than UDP allows";
    }
    const std::uint32_t length = std::uint32_t(frameHeaderSize + datagram.size);
    appendLittleEndian(std::uint32_t(datagram.stamp_ns / second_ns));
    appendLittleEndian(std::uint32_t(datagram.stamp_ns % second_ns));
    appendLittleEndian(length); // captured
    appendLittleEndian(length); // on the wire
    const auto header = makeFrameHeader(datagram);
    append(header.data(), header.size());
    append(datagram.payload, datagram.size);
    ++bufferedPackets_;
    return buffer_.size() < bufferSize ? Outcome<void>() : flush();
}

Outcome<void> PcapWriter::flush() {
    if (!isOpen())
        return sinceOpen();
    std::size_t done = 0;
    while (done < buffer_.size()) {
        const ssize_t count = ::write(file_, buffer_.data() + done, buffer_.size() - done);
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            return fail(count < 0 ? std::strerror(errno) : "nothing was written");
        done += std::size_t(count);
    }
    writtenBytes_ += buffer_.size();
    writtenPackets_ += bufferedPackets_;
    buffer_.clear();
    bufferedPackets_ = 0;
    return {};
}

Outcome<void> PcapWriter::close() {
    if (!isOpen())
        return sinceOpen();
    if (const Outcome<void> flushed = flush(); !flushed)
        return flushed;
    const int result = ::close(file_);
    file_ = -1;
    if (result != 0)
        error_ = path_ + ": cannot be closed: " + std::strerror(errno);
    return sinceOpen();
}

Outcome<void> PcapWriter::fail(const std::string &what) {
    error_ = path_ + ": cannot be written after byte " + std::to_string(writtenBytes_) + ": " + what;
    // Part of the buffer may have been written: cut it off, so that the file ends with a whole record.
    if (::ftruncate(file_, off_t(writtenBytes_)) != 0)
        error_ += "; the file may end in a broken record";
    ::close(file_);
    file_ = -1;
    buffer_.clear();
    bufferedPackets_ = 0;
    return error_;
}

} // namespace hermes
