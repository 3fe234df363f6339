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

namespace hermes {

namespace fs = std::filesystem;

/// Bytes of a file through zlib, which passes on what is not compressed.
class Input::Buffer : public std::streambuf {
public:
    explicit Buffer(int file)
        : m_file(gzdopen(file, "rb")) {
        if (m_file == nullptr)
            throw std::bad_alloc();
        gzbuffer(m_file, 1 << 17);
    }
    ~Buffer() override { gzclose(m_file); }
    Buffer(const Buffer &) = delete;
    Buffer &operator=(const Buffer &) = delete;

protected:
    int_type underflow() override {
        const int count = gzread(m_file, m_block.data(), unsigned(m_block.size()));
        int code = Z_OK;
        gzerror(m_file, &code);
        // A stream that throws here is bad, and its readers say so: compressed data damaged or cut short.
        if (count < 0 || (count == 0 && code != Z_OK && code != Z_STREAM_END))
            throw Failure("damaged data");
        setg(m_block.data(), m_block.data(), m_block.data() + count);
        return count == 0 ? traits_type::eof() : traits_type::to_int_type(m_block[0]);
    }

private:
    gzFile m_file;
    std::array<char, 1 << 16> m_block;
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
    : m_name(path == "-" ? "standard input" : path)
    , m_buffer(std::make_unique<Buffer>(openForReading(path)))
    , m_stream(m_buffer.get()) {}

Input::~Input() = default;

std::string Input::readAll(std::size_t limit) {
    std::string text;
    std::array<char, 1 << 16> block;
    while (m_stream.read(block.data(), block.size()) || m_stream.gcount() > 0) {
        text.append(block.data(), static_cast<std::size_t>(m_stream.gcount()));
        if (text.size() > limit)
            throw Failure(m_name + ": found over " + std::to_string(limit) +
                          " bytes, expected a smaller file");
    }
    if (m_stream.bad())
        throw Failure(
            m_name +
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
    : m_original(path)
    , m_path(path) {
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
    m_path = name;
    m_temporary = true;
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
    const std::size_t at = m_temporary ? message.find(m_path) : std::string::npos;
    return at == std::string::npos ? message : message.replace(at, m_path.size(), m_original);
}

PlainFile::~PlainFile() {
    std::error_code ignored;
    if (m_temporary)
        fs::remove(m_path, ignored);
}

} // namespace hermes
