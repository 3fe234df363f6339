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

#include <fcntl.h>
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
    int unnamed = -1;      ///< handle of a file without a name, where the file system offers one
    std::string temporary; ///< else its name until it is complete
    std::size_t slot = mostNames;
    std::ofstream file;
    std::ostream *stream = nullptr;

    /// Not so what is written directly: standard output, a pipe, a device.
    bool isHeldBack() const { return unnamed >= 0 || !temporary.empty(); }
    /// By which it can be opened, and given a name.
    std::string procPath() const { return "/proc/self/fd/" + std::to_string(unnamed); }
    std::string writtenAs() const { return unnamed >= 0 ? procPath() : temporary.empty() ? path : temporary; }
    void forget() {
        if (unnamed >= 0)
            close(unnamed);
        unnamed = -1;
        forgetName(slot);
        temporary.clear();
    }
    void discard() {
        file.close();
        if (!temporary.empty())
            unlink(temporary.c_str());
        forget();
    }
    /// Keeps what is written from the target; a file without a name is gone with the program, whatever ends
    /// it.
    void hold() {
        unnamed = ::open(fs::absolute(path).parent_path().c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
        if (unnamed >= 0 && access(procPath().c_str(), W_OK) == 0)
            return;
        forget();
        makeTemporary();
    }
    bool giveName(const std::string &name) const {
        return linkat(AT_FDCWD, procPath().c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
    }
    /// One that is taken by nothing else, for a file that is to replace another.
    bool giveTemporaryName() {
        makeTemporary();
        return unlink(temporary.c_str()) == 0 && giveName(temporary);
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
        std::error_code error;
        const fs::file_status status = fs::status(path, error);
        if (error == std::errc::filename_too_long) // which a file without a name would tell at its end only
            throw Failure(path + ": cannot be written: " + error.message());
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
            file->hold();
        file->file.open(file->writtenAs(), std::ios::binary);
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
        if (file->isHeldBack())
            finish(file->file, file->path, [&file] { file->file.close(); });
    for (const auto &file : files_)
        if (file->isHeldBack())
            putInPlace(*file);
    committed_ = true;
    // Pipes and devices last: no file is to be missed because the reader of a pipe has gone.
    for (const auto &file : files_)
        if (file->file.is_open())
            finish(file->file, file->path, [&file] { file->file.close(); });
    finish(std::cout, "standard output", [] { std::cout.flush(); });
}

void OutputSet::putInPlace(File &file) const {
    if (!(file.unnamed >= 0 ? nameIt(file) : renameIt(file)))
        throw Failure(file.path + ": cannot be put in its place: " + std::strerror(errno));
    file.forget();
}

// Another program may have made the file meanwhile: without force it is not replaced.
bool OutputSet::nameIt(File &file) const {
    return file.giveName(file.path) ||
           (force_ && errno == EEXIST && file.giveTemporaryName() && renameIt(file));
}

bool OutputSet::renameIt(File &file) const {
    const char *from = file.temporary.c_str(), *to = file.path.c_str();
    if (!force_ && link(from, to) == 0)
        return unlink(from) == 0;
    return (force_ || errno != EEXIST) && rename(from, to) == 0;
}

} // namespace hermes::vector
