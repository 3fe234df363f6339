#include "common/files/AppendFile.h"

#include <QFile>

#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace hermes {

bool AppendFile::open(const QString &path, int flags) {
    close();
    path_ = path;
    file_ =
        ::open(QFile::encodeName(path).constData(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | flags, 0644);
    isNamed_ = file_ >= 0 && isAtPath();
    struct stat status {};
    size_ = file_ >= 0 && ::fstat(file_, &status) == 0 ? quint64(status.st_size) : 0;
    return file_ >= 0 || fail("cannot be made");
}

bool AppendFile::create(const QString &path) {
    return open(path, O_EXCL);
}

bool AppendFile::resume(const QString &path) {
    if (!open(path, O_NOFOLLOW | O_NONBLOCK))
        return false;
    struct stat status {};
    if (::fstat(file_, &status) == 0 && S_ISREG(status.st_mode) && status.st_nlink == 1)
        return true;
    close();
    error_ = path + ": not a regular file, or one with another name";
    return false;
}

bool AppendFile::append(const void *bytes, std::size_t size) {
    const char *next = static_cast<const char *>(bytes);
    while (size > 0) {
        const ssize_t written = ::write(file_, next, size);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return fail("cannot be written");
        next += written;
        size -= std::size_t(written);
        size_ += quint64(written);
    }
    return true;
}

bool AppendFile::truncate(quint64 size) {
    if (::ftruncate(file_, off_t(size)) != 0)
        return fail("cannot be cut");
    size_ = size;
    return true;
}

bool AppendFile::sync() {
    return ::fdatasync(file_) == 0 || fail("cannot be written");
}

bool AppendFile::isRemoved() const {
    struct stat status {};
    return ::fstat(file_, &status) != 0 || status.st_nlink == 0;
}

bool AppendFile::isChanged() const {
    struct stat status {};
    return ::fstat(file_, &status) != 0 || quint64(status.st_size) != size_ || (isNamed_ && !isAtPath());
}

bool AppendFile::isAtPath() const {
    struct stat status {
    }, named{};
    return ::fstat(file_, &status) == 0 && ::stat(QFile::encodeName(path_).constData(), &named) == 0 &&
           named.st_ino == status.st_ino && named.st_dev == status.st_dev;
}

void AppendFile::close() {
    if (file_ >= 0)
        ::close(file_);
    file_ = -1;
}

bool AppendFile::fail(const char *what) {
    const int code = errno;
    error_ = QStringLiteral("%1: %2: %3").arg(path_, QLatin1String(what), qt_error_string(code));
    errno = code;
    return false;
}

} // namespace hermes
