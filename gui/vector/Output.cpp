#include "gui/vector/Output.h"
#include "common/platform/FileNames.h"
#include "common/platform/HeldFile.h"
#include "common/platform/TemporaryNames.h"
#include "gui/vector/Failure.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <utility>

namespace hermes::vector {

namespace fs = std::filesystem;

namespace {

/// Ends the writing of a stream; throws Failure when a part of it is missing.
template <typename End>
void finish(std::ostream &stream, const std::string &name, End end) {
    const bool wasBad = !stream; // long ago, so that the system no longer tells why
    errno = 0;
    end();
    if (!stream)
        throw Failure(name + ": cannot be written to its end: " +
                      (errno == EPIPE         ? "its reader has gone"
                       : wasBad || errno == 0 ? "its reader has gone, or there is no space left"
                                              : std::strerror(errno)));
}

fs::path absolutePath(const std::string &path) {
    return fs::absolute(fs::u8path(path)).lexically_normal();
}

} // namespace

struct OutputSet::File {
    /// Bytes into a stream of the C library, which has no buffer then.
    class Buffer : public std::streambuf {
    public:
        explicit Buffer(std::FILE *file)
            : file_(file) {
            std::setvbuf(file, nullptr, _IONBF, 0);
            setp(block_.data(), block_.data() + block_.size());
        }
        ~Buffer() override { close(); }
        Buffer(const Buffer &) = delete;
        Buffer &operator=(const Buffer &) = delete;

        /// False: not all is written.
        bool close() {
            if (file_ == nullptr)
                return true;
            const bool written = sync() == 0;
            return std::fclose(std::exchange(file_, nullptr)) == 0 && written;
        }

    protected:
        int_type overflow(int_type next) override {
            if (sync() != 0)
                return traits_type::eof();
            return next == traits_type::eof() ? traits_type::not_eof(next)
                                              : sputc(traits_type::to_char_type(next));
        }
        int sync() override {
            const auto size = std::size_t(pptr() - pbase());
            if (file_ == nullptr || std::fwrite(pbase(), 1, size, file_) != size)
                return -1;
            setp(block_.data(), block_.data() + block_.size());
            return 0;
        }

    private:
        std::FILE *file_;
        std::array<char, 1 << 16> block_;
    };

    std::string path;
    std::unique_ptr<HeldFile> held; ///< not so what is written directly: standard output, a pipe, a device
    std::unique_ptr<Buffer> buffer; ///< into it
    std::unique_ptr<std::ostream> heldStream;
    std::ofstream direct;
    std::ostream *stream = nullptr;

    void hold() {
        Outcome<std::unique_ptr<HeldFile>> made = HeldFile::make(path);
        if (!made)
            throw Failure(path + ": cannot be written: " + made.error());
        held = made.take();
        std::FILE *const file = held->open();
        if (file == nullptr)
            throw Failure(path + ": cannot be written: " + std::strerror(errno));
        buffer = std::make_unique<Buffer>(file);
        heldStream = std::make_unique<std::ostream>(buffer.get());
        stream = heldStream.get();
    }
    void openDirectly() {
        direct.open(fs::u8path(path), std::ios::binary);
        if (!direct)
            throw Failure(path + ": cannot be written: " + std::strerror(errno));
        stream = &direct;
    }
    void close() {
        if (!buffer->close())
            stream->setstate(std::ios::badbit);
    }
};

OutputSet::OutputSet(bool force)
    : force_(force) {}

OutputSet::~OutputSet() {
    files_.clear();
    std::error_code ignored;
    for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder) {
        if (!committed_)
            fs::remove(fs::u8path(folder->path), ignored); // keeps what somebody else put into it
        forgetTemporary(folder->place);
    }
}

void OutputSet::makeFolder(const std::string &path) {
    if (path.empty())
        throw Failure("--out: found an empty name, expected a folder");
    std::error_code error;
    fs::path whole;
    for (const fs::path &part : absolutePath(path)) {
        whole /= part;
        if (part.has_filename() && fs::create_directory(whole, error))
            folders_.push_back({whole.u8string(), rememberTemporary(whole.u8string())});
        if (error)
            throw Failure(path + ": cannot be made: " + error.message());
    }
}

std::ostream &OutputSet::open(const std::string &path) {
    auto file = std::make_unique<File>();
    if (path.empty() || path == "-") {
        file->path = "standard output";
        file->stream = &std::cout;
        for (const auto &other : files_)
            if (other->stream == &std::cout)
                throw Failure(
                    "standard output: asked for twice, expected a name of its own for every output");
    } else {
        std::error_code error;
        const fs::path name = fs::u8path(path);
        const fs::file_status status = fs::status(name, error);
        if (error == std::errc::filename_too_long) // which a file without a name would tell at its end only
            throw Failure(path + ": cannot be written: " + error.message());
        if (fs::is_directory(status))
            throw Failure(path + ": found a folder, expected the name of a file to write");
        const bool plain = (!fs::exists(status) || fs::is_regular_file(status)) && !isDeviceName(name);
        if (plain && fs::exists(status) && !force_)
            throw Failure(path + ": exists already; choose another name or overwrite it with --force");
        // Through a symbolic link the file it points to is replaced, not the link.
        file->path = plain && fs::exists(status) ? fs::canonical(name).u8string() : path;
        for (const auto &other : files_)
            if (isSameName(absolutePath(other->path), absolutePath(file->path)))
                throw Failure(path + ": asked for twice, expected a name of its own for every output");
        if (plain)
            file->hold();
        else
            file->openDirectly();
    }
    files_.push_back(std::move(file));
    return *files_.back()->stream;
}

void OutputSet::commit() {
    for (const auto &file : files_)
        if (file->held)
            finish(*file->stream, file->path, [&file] { file->close(); });
    for (const auto &file : files_)
        if (file->held)
            if (const Outcome<void> put = file->held->putInPlace(force_); !put)
                throw Failure(file->path + ": cannot be put in its place: " + put.error());
    committed_ = true;
    // Pipes and devices last: no file is to be missed because the reader of a pipe has gone.
    for (const auto &file : files_)
        if (file->direct.is_open())
            finish(file->direct, file->path, [&file] { file->direct.close(); });
    finish(std::cout, "standard output", [] { std::cout.flush(); });
}

} // namespace hermes::vector
