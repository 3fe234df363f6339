#include "common/capture/PcapWriter.h"

#include "common/capture/Frame.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace hermes {

namespace {

constexpr std::uint32_t version = 4u << 16 | 2; // 2.4, as two 16-bit words
constexpr std::uint32_t snapLength = 262144;    // the most that readers accept
constexpr std::size_t bufferSize = 256 * 1024;  // about a tenth of a second of an HDL-32E
constexpr std::int64_t second_ns = 1000000000;

} // namespace

PcapWriter::~PcapWriter() {
    close();
}

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

Outcome<void> PcapWriter::sinceOpen() const {
    return error_.empty() ? Outcome<void>() : error_;
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

void PcapWriter::append(const void *bytes, std::size_t size) {
    const auto *begin = static_cast<const std::uint8_t *>(bytes);
    buffer_.insert(buffer_.end(), begin, begin + size);
}

void PcapWriter::appendLittleEndian(std::uint32_t value) {
    const std::uint8_t bytes[4] = {std::uint8_t(value), std::uint8_t(value >> 8), std::uint8_t(value >> 16),
                                   std::uint8_t(value >> 24)};
    append(bytes, sizeof bytes);
}

} // namespace hermes
