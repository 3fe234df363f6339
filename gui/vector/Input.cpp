#include "gui/vector/Input.h"
#include "common/platform/ReadableFile.h"
#include "common/progress/Progress.h"
#include "gui/vector/Failure.h"
#include "vectorlib/io/CsvPoints.h"
#include "vectorlib/io/Pcd.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <zlib.h>

namespace hermes::vector {

namespace fs = std::filesystem;

std::string worldFile(const std::string &nameOrPath) {
    const fs::path path = fs::u8path(nameOrPath);
    std::error_code error;
    if (nameOrPath == "-" || path.has_parent_path() || fs::exists(path, error))
        return nameOrPath;
    const fs::path installed = installedWorlds() / fs::u8path(nameOrPath + ".json");
    if (fs::exists(installed, error))
        return installed.u8string();
    std::set<std::string> names;
    for (fs::directory_iterator file(installedWorlds(), error), end; !error && file != end;
         file.increment(error))
        if (file->path().extension() == ".json")
            names.insert(file->path().stem().u8string());
    std::string list;
    for (const std::string &name : names)
        list += (list.empty() ? "" : ", ") + name;
    throw Failure(nameOrPath + ": found no such file, expected one, or the name of a world: " + list);
}

/// Bytes of a file through zlib, which passes on what is not compressed.
class Input::Buffer : public std::streambuf {
public:
    /// bytes: of the file, 0 when that is not known.
    Buffer(int file, std::uintmax_t bytes)
        : file_(gzdopen(file, "rb"))
        , kilobytes_(double(bytes / 1000)) {
        if (file_ == nullptr)
            throw std::bad_alloc();
        gzbuffer(file_, 1 << 17);
    }
    ~Buffer() override { gzclose(file_); }
    Buffer(const Buffer &) = delete;
    Buffer &operator=(const Buffer &) = delete;

    /// The first bytes, which are not read by that; only before anything is.
    std::string_view begin() {
        if (gptr() == egptr())
            underflow();
        return {gptr(), std::size_t(egptr() - gptr())};
    }

protected:
    int_type underflow() override {
        const int count = gzread(file_, block_.data(), unsigned(block_.size()));
        int code = Z_OK;
        gzerror(file_, &code);
        // A stream that throws here is bad, and its readers say so: compressed data damaged or cut short.
        if (count < 0 || (count == 0 && code != Z_OK && code != Z_STREAM_END))
            throw Failure("damaged data");
        setg(block_.data(), block_.data(), block_.data() + count);
        if (progress_) // of a compressed file its own bytes count
            progress_->update(count == 0 ? kilobytes_ : double(gzoffset(file_) / 1000), kilobytes_);
        if (count == 0)
            progress_.reset();
        return count == 0 ? traits_type::eof() : traits_type::to_int_type(block_[0]);
    }

private:
    gzFile file_;
    const double kilobytes_;
    std::optional<Progress> progress_{std::in_place, "reading, kB"};
    std::array<char, 1 << 16> block_;
};

namespace {

int descriptorOf(const std::string &path) {
    if (path == "-")
        return standardInput();
    std::error_code ignored;
    if (fs::is_directory(fs::u8path(path), ignored))
        throw Failure(path + ": found a folder, expected a file");
    const Outcome<int> file = openForReading(path);
    if (!file)
        throw Failure(path + ": cannot be opened: " + file.error());
    return *file;
}

/// 0 of what is no file, as a pipe.
std::uintmax_t sizeOf(const std::string &path) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(fs::u8path(path), error);
    return error ? 0 : size;
}

std::string lowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
    return text;
}

bool endsWith(const std::string &text, const std::string &end) {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

} // namespace

Input::Input(const std::string &path)
    : name_(path == "-" ? "standard input" : path)
    , buffer_(std::make_unique<Buffer>(descriptorOf(path), sizeOf(path)))
    , stream_(buffer_.get()) {}

Input::~Input() = default;

bool Input::isCapture() {
    // pcap in both byte orders, with microseconds or nanoseconds, and pcapng.
    constexpr std::string_view known[] = {"\xa1\xb2\xc3\xd4", "\xd4\xc3\xb2\xa1", "\xa1\xb2\x3c\x4d",
                                          "\x4d\x3c\xb2\xa1", "\x0a\x0d\x0d\x0a"};
    try {
        const std::string_view magic = buffer_->begin().substr(0, 4);
        return std::find(std::begin(known), std::end(known), magic) != std::end(known);
    } catch (const Failure &) {
        return false; // damaged from the beginning, which is told where it is read
    }
}

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

/// Hands the text out in blocks.
class TextStream::Buffer : public std::streambuf {
public:
    explicit Buffer(std::string text)
        : text_(std::move(text)) {}

protected:
    int_type underflow() override {
        constexpr std::size_t block = 1 << 16;
        char *const begin = text_.data() + at_;
        const std::size_t count = std::min(block, text_.size() - at_);
        progress_.update(double(at_ / 1000), double(text_.size() / 1000));
        at_ += count;
        setg(begin, begin, begin + count);
        return count == 0 ? traits_type::eof() : traits_type::to_int_type(*begin);
    }

private:
    std::string text_;
    std::size_t at_ = 0;
    Progress progress_{"parsing, kB"};
};

TextStream::TextStream(std::string text)
    : std::istream(nullptr)
    , buffer_(std::make_unique<Buffer>(std::move(text))) {
    rdbuf(buffer_.get());
}

TextStream::~TextStream() = default;

bool hasExtension(const std::string &path, const std::string &extension) {
    std::string lower = lowerCase(path);
    if (endsWith(lower, ".gz"))
        lower.resize(lower.size() - 3);
    return endsWith(lower, extension);
}

namespace {

[[noreturn]] void refuse(const std::string &path, const char *found) {
    throw Failure(path + ": found a " + found +
                  ", expected one scan; take scan number N out of it by: hermes-vector map " + path +
                  " --scan N --out scan.csv");
}

} // namespace

std::vector<vectorlib::Vector2D<double>> loadPoints(const std::string &path) {
    Input input(path);
    TextStream in(readScanText(input, path));
    return valueOrFail(hasExtension(path, ".pcd") ? vectorlib::readPcd<double>(in, input.name())
                                                  : vectorlib::readCsvPoints<double>(in, input.name()));
}

std::string readScanText(Input &input, const std::string &path) {
    if (input.isCapture())
        refuse(path, "capture");
    std::string text = input.readAll();
    for (const std::string word : {"FLASER ", "ROBOTLASER1 "})
        if (text.rfind(word, 0) == 0 || text.find('\n' + word) != std::string::npos)
            refuse(path, "CARMEN log");
    return text;
}

} // namespace hermes::vector
