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

// Names of the temporary files, where a signal handler can read them.
constexpr std::size_t mostFiles = 16;
char temporaries[mostFiles][PATH_MAX];

void removeAndDie(int signal) {
    for (const auto &name : temporaries)
        if (name[0] != '\0')
            unlink(name);
    std::signal(signal, SIG_DFL);
    raise(signal);
}

mode_t usualPermissions() {
    const mode_t mask = umask(0);
    umask(mask);
    return 0666 & ~mask;
}

} // namespace

void removeTemporariesOnSignal() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE})
        std::signal(signal, removeAndDie);
}

struct OutputSet::File {
    std::string path;
    std::string temporary; ///< empty when written directly: standard output, a pipe, a device
    std::size_t slot = mostFiles;
    std::ofstream file;
    std::ostream *stream = nullptr;

    void forget() {
        if (slot < mostFiles)
            temporaries[slot][0] = '\0';
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
        for (slot = 0; slot < mostFiles && temporaries[slot][0] != '\0';)
            ++slot;
        if (slot < mostFiles && temporary.size() < PATH_MAX)
            std::strcpy(temporaries[slot], temporary.c_str());
    }
};

OutputSet::OutputSet(bool force)
    : force_(force) {}

OutputSet::~OutputSet() {
    for (const auto &file : files_)
        file->discard();
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
        file->path = fs::exists(status) ? fs::canonical(path).string() : path;
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
    for (const auto &file : files_) {
        file->stream->flush();
        if (file->stream == &file->file)
            file->file.close();
        if (!*file->stream)
            throw Failure(file->path + ": cannot be written to its end: " + std::strerror(errno));
    }
    for (const auto &file : files_) {
        if (file->temporary.empty())
            continue;
        // Another program may have made the file meanwhile: without force it is not replaced.
        const int result = force_ ? rename(file->temporary.c_str(), file->path.c_str())
                                  : link(file->temporary.c_str(), file->path.c_str());
        if (result != 0 &&
            (force_ || errno == EEXIST || rename(file->temporary.c_str(), file->path.c_str()) != 0))
            throw Failure(file->path + ": cannot be put in its place: " + std::strerror(errno));
        unlink(file->temporary.c_str());
        file->forget();
    }
}

} // namespace hermes::vector
