#include "common/platform/HeldFile.h"

#include "common/platform/TemporaryNames.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>

namespace hermes {

namespace {

std::string errorText() {
    return std::strerror(errno);
}

mode_t usualPermissions() {
    const mode_t mask = ::umask(0);
    ::umask(mask);
    return 0666 & ~mask;
}

/// Gone with the process, whatever ends it.
class UnnamedFile : public HeldFile {
public:
    explicit UnnamedFile(const std::string &path)
        : path_(path)
        , file_(::open(std::filesystem::absolute(path).parent_path().c_str(),
                       O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666)) {}
    ~UnnamedFile() override {
        if (file_ >= 0)
            ::close(file_);
    }

    bool isPossible() const { return file_ >= 0 && ::access(procPath().c_str(), W_OK) == 0; }
    std::FILE *open() override { return ::fdopen(::fcntl(file_, F_DUPFD_CLOEXEC, 0), "wb"); }
    // Another program may have made the file meanwhile: without replace it stays.
    Outcome<void> putInPlace(bool replace) override {
        if (giveName(path_) || (replace && errno == EEXIST && giveTemporaryName()))
            return {};
        return errorText();
    }

private:
    /// By which it can be opened, and given a name.
    std::string procPath() const { return "/proc/self/fd/" + std::to_string(file_); }
    bool giveName(const std::string &name) const {
        return ::linkat(AT_FDCWD, procPath().c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
    }
    /// One that nothing else has, and by it the place of another file.
    bool giveTemporaryName() const {
        std::string name = path_ + ".part-XXXXXX";
        const int handle = ::mkstemp(name.data());
        if (handle < 0)
            return false;
        ::close(handle);
        const std::size_t place = rememberTemporary(name);
        const bool done =
            ::unlink(name.c_str()) == 0 && giveName(name) && ::rename(name.c_str(), path_.c_str()) == 0;
        const int why = errno;
        if (!done)
            ::unlink(name.c_str());
        forgetTemporary(place);
        errno = why;
        return done;
    }

    const std::string path_;
    const int file_;
};

class TemporaryFile : public HeldFile {
public:
    explicit TemporaryFile(const std::string &path)
        : path_(path)
        , name_(path + ".part-XXXXXX")
        , file_(::mkostemp(name_.data(), O_CLOEXEC)) {
        if (file_ < 0)
            return;
        ::fchmod(file_, usualPermissions());
        place_ = rememberTemporary(name_);
    }
    ~TemporaryFile() override {
        if (file_ < 0)
            return;
        if (!isInPlace_)
            ::unlink(name_.c_str());
        ::close(file_);
        forgetTemporary(place_);
    }

    bool isThere() const { return file_ >= 0; }
    std::FILE *open() override { return ::fdopen(::fcntl(file_, F_DUPFD_CLOEXEC, 0), "wb"); }
    Outcome<void> putInPlace(bool replace) override {
        const char *from = name_.c_str(), *to = path_.c_str();
        if (!replace && ::link(from, to) == 0)
            isInPlace_ = ::unlink(from) == 0;
        else // a file system without links, perhaps
            isInPlace_ = (replace || errno != EEXIST) && ::rename(from, to) == 0;
        return isInPlace_ ? Outcome<void>() : errorText();
    }

private:
    const std::string path_;
    std::string name_;
    const int file_;
    std::size_t place_ = 0;
    bool isInPlace_ = false;
};

} // namespace

Outcome<std::unique_ptr<HeldFile>> HeldFile::make(const std::string &path) {
    if (auto unnamed = std::make_unique<UnnamedFile>(path); unnamed->isPossible())
        return std::unique_ptr<HeldFile>(std::move(unnamed));
    auto temporary = std::make_unique<TemporaryFile>(path);
    if (!temporary->isThere())
        return errorText();
    return std::unique_ptr<HeldFile>(std::move(temporary));
}

} // namespace hermes
