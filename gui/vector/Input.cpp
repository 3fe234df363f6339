#include "gui/vector/Input.h"

#include "gui/vector/Failure.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <unistd.h>

namespace hermes::vector {

namespace fs = std::filesystem;

/// Bytes of a file through zlib, which passes on what is not compressed.
class Input::Buffer : public std::streambuf {
public:
    explicit Buffer(int file)
        : file_(gzdopen(file, "rb")) {
        if (file_ == nullptr)
            throw std::bad_alloc();
        gzbuffer(file_, 1 << 17);
    }
    ~Buffer() override { gzclose(file_); }
    Buffer(const Buffer &) = delete;
    Buffer &operator=(const Buffer &) = delete;

protected:
    int_type underflow() override {
        const int count = gzread(file_, block_.data(), unsigned(block_.size()));
        int code = Z_OK;
        gzerror(file_, &code);
        // A stream that throws here is bad, and its readers say so: compressed data damaged or cut short.
        if (count < 0 || (count == 0 && code != Z_OK && code != Z_STREAM_END))
            throw Failure("damaged data");
        setg(block_.data(), block_.data(), block_.data() + count);
        return count == 0 ? traits_type::eof() : traits_type::to_int_type(block_[0]);
    }

private:
    gzFile file_;
    std::array<char, 1 << 16> block_;
};

namespace {

int openForReading(const std::string &path) {
    if (path == "-")
        return dup(STDIN_FILENO);
    std::error_code ignored;
    if (fs::is_directory(path, ignored))
        throw Failure(path + ": found a folder, expected a file");
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0)
        throw Failure(path + ": cannot be opened: " + std::strerror(errno));
    return file;
}

std::string lowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
    return text;
}

bool endsWith(const std::string &text, const std::string &end) {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

bool isCompressed(const std::string &path) {
    std::ifstream in(path, std::ios::binary);
    return in.get() == 0x1f && in.get() == 0x8b;
}

} // namespace

Input::Input(const std::string &path)
    : name_(path == "-" ? "standard input" : path)
    , buffer_(std::make_unique<Buffer>(openForReading(path)))
    , stream_(buffer_.get()) {}

Input::~Input() = default;

std::string Input::readAll(std::size_t limit) {
    std::string text;
    std::array<char, 1 << 16> block;
    while (stream_.read(block.data(), block.size()) || stream_.gcount() > 0) {
        text.append(block.data(), static_cast<std::size_t>(stream_.gcount()));
        if (text.size() > limit)
            throw Failure(name_ + ": found over " + std::to_string(limit) +
                          " bytes, expected a smaller file");
    }
    if (stream_.bad())
        throw Failure(
            name_ +
            ": found input that ends or breaks off too early, expected input that can be read to its end");
    return text;
}

bool hasExtension(const std::string &path, const std::string &extension) {
    std::string lower = lowerCase(path);
    if (endsWith(lower, ".gz"))
        lower.resize(lower.size() - 3);
    return endsWith(lower, extension);
}

bool isCapture(const std::string &path) {
    if (path == "-")
        return false;
    Input input(path);
    unsigned char magic[4] = {};
    input.stream().read(reinterpret_cast<char *>(magic), sizeof magic);
    // pcap in both byte orders, with microseconds or nanoseconds, and pcapng.
    constexpr unsigned char known[][4] = {{0xa1, 0xb2, 0xc3, 0xd4},
                                          {0xd4, 0xc3, 0xb2, 0xa1},
                                          {0xa1, 0xb2, 0x3c, 0x4d},
                                          {0x4d, 0x3c, 0xb2, 0xa1},
                                          {0x0a, 0x0d, 0x0d, 0x0a}};
    return input.stream().gcount() == 4 &&
           std::any_of(std::begin(known), std::end(known),
                       [&](const auto &k) { return std::memcmp(k, magic, sizeof magic) == 0; });
}

PlainFile::PlainFile(const std::string &path)
    : original_(path)
    , path_(path) {
    if (path == "-")
        return;
    Input input(path);
    if (!isCompressed(path))
        return;
    std::string name = (fs::temp_directory_path() / "hermes-vector-XXXXXX").string();
    const int file = mkstemp(name.data());
    if (file < 0)
        throw Failure(name + ": cannot be made: " + std::strerror(errno));
    close(file);
    path_ = name;
    temporary_ = true;
    std::ofstream out(name, std::ios::binary);
    std::array<char, 1 << 16> block;
    while (out && (input.stream().read(block.data(), block.size()) || input.stream().gcount() > 0))
        out.write(block.data(), input.stream().gcount());
    out.close();
    if (!out || input.stream().bad()) {
        fs::remove(name);
        throw Failure(path + (out ? ": found compressed data that breaks off, expected a whole file"
                                  : ": cannot be decompressed to " + name));
    }
}

std::string PlainFile::inWordsOfOriginal(std::string message) const {
    const std::size_t at = temporary_ ? message.find(path_) : std::string::npos;
    return at == std::string::npos ? message : message.replace(at, path_.size(), original_);
}

PlainFile::~PlainFile() {
    std::error_code ignored;
    if (temporary_)
        fs::remove(path_, ignored);
}

} // namespace hermes::vector
