#include "gui/vector/Output.h"

#include "gui/vector/Failure.h"

#include <array>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <sys/stat.h>
#include <unistd.h>

namespace hermes::vector {

namespace fs = std::filesystem;

namespace {

// Names of the temporary files, and of the folders that were made, where a signal handler can read them.
constexpr std::size_t mostNames = 32;
char temporaries[mostNames][PATH_MAX];

// A folder has its place before what lies in it.
void removeAndDie(int signal) {
    for (std::size_t i = mostNames; i-- > 0;)
        if (temporaries[i][0] != '\0' && unlink(temporaries[i]) != 0)
            rmdir(temporaries[i]);
    std::signal(signal, SIG_DFL);
    raise(signal);
}

/// The place of a name in the list; mostNames when it is full or the name is too long.
std::size_t remember(const std::string &name) {
    std::size_t slot = 0;
    while (slot < mostNames && temporaries[slot][0] != '\0')
        ++slot;
    if (slot == mostNames || name.size() >= PATH_MAX)
        return mostNames;
    std::strcpy(temporaries[slot], name.c_str());
    return slot;
}

void forgetName(std::size_t slot) {
    if (slot < mostNames)
        temporaries[slot][0] = '\0';
}

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

mode_t usualPermissions() {
    const mode_t mask = umask(0);
    umask(mask);
    return 0666 & ~mask;
}

} // namespace

void handleSignals() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        std::signal(signal, removeAndDie);
    std::signal(SIGPIPE, SIG_IGN); // a reader that went away is an error of writing, told by commit()
}

struct OutputSet::File {
    std::string path;
    std::string temporary; ///< empty when written directly: standard output, a pipe, a device
    std::size_t slot = mostNames;
    std::ofstream file;
    std::ostream *stream = nullptr;

    void forget() {
        forgetName(slot);
        temporary.clear();
    }
    void discard() {
        file.close();
        if (!temporary.empty())
            unlink(temporary.c_str());
        forget();
    }
    void makeTemporary() {
        temporary = path + ".part-XXXXXX";
        const int handle = mkstemp(temporary.data());
        if (handle < 0) {
            const std::string why = std::strerror(errno);
            temporary.clear();
            throw Failure(path + ": cannot be written: " + why);
        }
        fchmod(handle, usualPermissions());
        close(handle);
        slot = remember(temporary);
    }
};

OutputSet::OutputSet(bool force)
    : force_(force) {}

OutputSet::~OutputSet() {
    for (const auto &file : files_)
        file->discard();
    for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder) {
        if (!committed_)
            rmdir(folder->path.c_str()); // keeps what somebody else put into it
        forgetName(folder->slot);
    }
}

void OutputSet::makeFolder(const std::string &path) {
    std::error_code error;
    fs::path whole;
    for (const fs::path &part : fs::absolute(path).lexically_normal()) {
        whole /= part;
        if (!part.empty() && fs::create_directory(whole, error))
            folders_.push_back({whole.string(), remember(whole.string())});
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
        std::error_code ignored;
        const fs::file_status status = fs::status(path, ignored);
        if (fs::is_directory(status))
            throw Failure(path + ": found a folder, expected the name of a file to write");
        const bool plain = !fs::exists(status) || fs::is_regular_file(status);
        if (plain && fs::exists(status) && !force_)
            throw Failure(path + ": exists already; choose another name or overwrite it with --force");
        // Through a symbolic link the file it points to is replaced, not the link.
        file->path = plain && fs::exists(status) ? fs::canonical(path).string() : path;
        for (const auto &other : files_)
            if (fs::absolute(other->path).lexically_normal() == fs::absolute(file->path).lexically_normal())
                throw Failure(path + ": asked for twice, expected a name of its own for every output");
        if (plain)
            file->makeTemporary();
        file->file.open(file->temporary.empty() ? file->path : file->temporary, std::ios::binary);
        file->stream = &file->file;
        if (!file->file) {
            const std::string why = std::strerror(errno);
            file->discard();
            throw Failure(path + ": cannot be written: " + why);
        }
    }
    files_.push_back(std::move(file));
    return *files_.back()->stream;
}

void OutputSet::commit() {
    for (const auto &file : files_)
        if (!file->temporary.empty())
            finish(file->file, file->path, [&file] { file->file.close(); });
    for (const auto &file : files_)
        if (!file->temporary.empty())
            putInPlace(*file);
    committed_ = true;
    // Pipes and devices last: no file is to be missed because the reader of a pipe has gone.
    for (const auto &file : files_)
        if (file->file.is_open())
            finish(file->file, file->path, [&file] { file->file.close(); });
    finish(std::cout, "standard output", [] { std::cout.flush(); });
}

void OutputSet::putInPlace(File &file) const {
    // Another program may have made the file meanwhile: without force it is not replaced.
    const int result = force_ ? rename(file.temporary.c_str(), file.path.c_str())
                              : link(file.temporary.c_str(), file.path.c_str());
    if (result != 0 && (force_ || errno == EEXIST || rename(file.temporary.c_str(), file.path.c_str()) != 0))
        throw Failure(file.path + ": cannot be put in its place: " + std::strerror(errno));
    unlink(file.temporary.c_str());
    file.forget();
}

} // namespace hermes::vector
