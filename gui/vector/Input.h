#pragma once

#include <istream>
#include <memory>
#include <string>
#include <vector>

namespace hermes::vector {

/// A file to read, plain or gzip-compressed, or standard input for `-`. A file that breaks off in the middle
/// of its compressed data makes the stream bad instead of ending it. Reading tells its progress.
class Input {
public:
    /// Throws Failure when there is no such file or it is a folder.
    explicit Input(const std::string &path);
    ~Input();

    std::istream &stream() { return stream_; }
    /// How messages call it.
    const std::string &name() const { return name_; }
    /// Whether it begins like a pcap or pcapng capture, plain or compressed. Asked before anything is read,
    /// and reads nothing: a pipe can be read only once.
    bool isCapture();
    /// Everything that is left, as one text; throws Failure over `limit` bytes.
    std::string readAll(std::size_t limit = std::size_t(256) << 20);

private:
    class Buffer;
    std::string name_;
    std::unique_ptr<Buffer> buffer_;
    std::istream stream_;
};

/// A text as a stream, which tells how far it is read.
class TextStream : public std::istream {
public:
    explicit TextStream(std::string text);
    ~TextStream() override;

private:
    class Buffer;
    std::unique_ptr<Buffer> buffer_;
};

/// Whether the path ends with the extension (with dot, lower case), a further .gz left aside; case does not
/// matter.
bool hasExtension(const std::string &path, const std::string &extension);

} // namespace hermes::vector
