#include "common/files/NamedFile.h"

#include "common/files/WriteAll.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonObject>
#include <QUuid>
#include <algorithm>
#include <utility>

#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace hermes {
namespace {

/// A descriptor that is closed when it is no longer needed.
class Descriptor {
public:
    explicit Descriptor(int number = -1)
        : number_(number) {}
    Descriptor(Descriptor &&other) noexcept
        : number_(std::exchange(other.number_, -1)) {}
    Descriptor &operator=(Descriptor &&other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    ~Descriptor() {
        if (number_ >= 0)
            ::close(number_);
    }
    operator int() const { return number_; }
    int release() { return std::exchange(number_, -1); }

private:
    int number_;
};

Error fileError(const QString &path, const QString &what) {
    const bool isRelative = !path.isEmpty() && QDir::isRelativePath(path);
    const QString whole = isRelative ? absolutePath(path) : path;
    const QString where = isRelative ? QString(" (\"%1\" was looked for in %2, where this program runs)")
                                           .arg(path, QDir::currentPath())
                                     : QString();
    return {ErrorCode::InputOutput, QString("%1: %2%3").arg(whole, what, where),
            QJsonObject{{"path", whole}}};
}

/// Without links; empty, and errno says why.
QString realPath(const QString &path) {
    char *const real = ::realpath(QFile::encodeName(path).constData(), nullptr);
    const QString result = real ? QFile::decodeName(real) : QString();
    ::free(real);
    return result;
}

/// path: without links.
bool isBelow(const QString &path, const QString &folder) {
    const QString real = realPath(folder);
    return !real.isEmpty() &&
           path.startsWith(real.endsWith(QLatin1Char('/')) ? real : real + QLatin1Char('/'));
}

/// Whether the text can be the path of a file.
Result<void> checkPath(const QString &path) {
    const bool hasControls = std::any_of(path.begin(), path.end(), [](QChar c) {
        return c.category() == QChar::Other_Control || c == QChar::LineSeparator ||
               c == QChar::ParagraphSeparator;
    });
    const QString name = path.section(QLatin1Char('/'), -1);
    if (name.isEmpty() || name == "." || name == ".." || hasControls || path.toUtf8().size() >= PATH_MAX) {
        return fileError(path.left(100), QString("expected the path of a file, without control "
                                                 "characters and of less than %1 bytes")
                                             .arg(PATH_MAX));
    }
    return {};
}

/// What a name leads to, where that is another file.
QString whereLinked(const QString &named, const QString &path) {
    const bool isLinked = path != absolutePath(named);
    return isLinked ? QString("this is %1, ").arg(path) : QString();
}

/// path: without links.
Result<void> checkFolders(const QString &named, const QString &path, const QStringList &folders) {
    if (std::any_of(folders.begin(), folders.end(),
                    [&path](const QString &folder) { return isBelow(path, folder); }))
        return {};
    return fileError(named, QString("%1not below %2, where files may be named")
                                .arg(whereLinked(named, path), folders.join(" or ")));
}

/// The folder of the path, which has no links, for openat(); nothing: errno says why.
Descriptor openFolder(const QString &path) {
    Descriptor folder(::open("/", O_PATH | O_DIRECTORY | O_CLOEXEC));
    for (const QString &step : path.split(QLatin1Char('/'), Qt::SkipEmptyParts)) {
        folder = Descriptor(::openat(folder, QFile::encodeName(step).constData(),
                                     O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
        if (folder < 0)
            break;
    }
    return folder;
}

/// For reading; open() of a device or a pipe may do something, or wait, so it is looked at first. path:
/// without links.
Result<Descriptor> openRegular(const QString &named, const QString &path) {
    const auto failed = [&](const QString &why) { return fileError(named, whereLinked(named, path) + why); };
    const QFileInfo file(path);
    const Descriptor folder = openFolder(file.path());
    const QByteArray name = QFile::encodeName(file.fileName());
    struct stat status {};
    if (folder < 0 || ::fstatat(folder, name.constData(), &status, AT_SYMLINK_NOFOLLOW) != 0)
        return failed("cannot be read: " + qt_error_string());
    if (!S_ISREG(status.st_mode))
        return failed("not a regular file");
    Descriptor opened(
        ::openat(folder, name.constData(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
    if (opened < 0 || ::fstat(opened, &status) != 0)
        return failed("cannot be read: " + qt_error_string());
    if (!S_ISREG(status.st_mode))
        return failed("not a regular file");
    return opened;
}

struct Opened {
    QString path;
    Descriptor file;
    qint64 bytes; ///< none: it is empty, or one of /proc, some of which have no end
};

Result<Opened> openNamed(const QString &path, const QStringList &folders) {
    if (const Result<void> fine = checkPath(path); !fine)
        return fine.error();
    const QString found = realPath(path);
    if (found.isEmpty())
        return fileError(path, "cannot be read: " + qt_error_string());
    if (const Result<void> fine = checkFolders(path, found, folders); !fine)
        return fine.error();
    Result<Descriptor> file = openRegular(path, found);
    if (!file)
        return file.error();
    struct stat status {};
    ::fstat(*file, &status);
    return Opened{found, std::move(*file), status.st_size};
}

/// So that the name is on the disk, too.
Result<void> syncNamesIn(const QString &path) {
    const Descriptor folder(::open(QFile::encodeName(path).constData(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folder >= 0 && ::fsync(folder) == 0)
        return {};
    return fileError(path, "cannot be synchronized: " + qt_error_string());
}

} // namespace

QString absolutePath(const QString &path) {
    return QDir::cleanPath(QFileInfo(path).absoluteFilePath());
}

Result<QByteArray> readNamedFile(const QString &path, const QStringList &folders, qint64 maxBytes) {
    const Result<Opened> opened = openNamed(path, folders);
    if (!opened)
        return opened.error();
    if (opened->bytes == 0 || opened->bytes > maxBytes)
        return fileError(path, QString("it has %1 bytes, expected 1 to %2").arg(opened->bytes).arg(maxBytes));
    QByteArray bytes(int(opened->bytes), Qt::Uninitialized);
    int done = 0;
    while (done < bytes.size()) {
        const ssize_t read = ::read(opened->file, bytes.data() + done, size_t(bytes.size() - done));
        if (read < 0 && errno != EINTR)
            return fileError(path, "cannot be read: " + qt_error_string());
        if (read == 0) // it was cut meanwhile
            break;
        done += int(std::max<ssize_t>(read, 0));
    }
    bytes.truncate(done);
    return bytes;
}

Result<QString> findNamedFile(const QString &path, const QStringList &folders, qint64 leastBytes) {
    const Result<Opened> opened = openNamed(path, folders);
    if (!opened)
        return opened.error();
    if (opened->bytes < leastBytes)
        return fileError(path,
                         QString("it has %1 bytes, expected at least %2").arg(opened->bytes).arg(leastBytes));
    return opened->path;
}

Result<void> writeNamedFile(const QString &path, const QStringList &folders, const QByteArray &bytes,
                            bool replace) {
    if (const Result<void> fine = checkPath(path); !fine)
        return fine.error();
    const QFileInfo named(path);
    const QString parent = realPath(named.path());
    if (parent.isEmpty())
        return fileError(path, "cannot be written: its folder: " + qt_error_string());
    const QString target = QDir(parent).filePath(named.fileName());
    if (const Result<void> fine = checkFolders(path, target, folders); !fine)
        return fine.error();
    const auto failed = [&path] { return fileError(path, "cannot be written: " + qt_error_string()); };
    const Descriptor folder = openFolder(parent);
    if (folder < 0)
        return failed();
    const QByteArray name = QFile::encodeName(named.fileName());
    struct stat status {};
    const bool exists = ::fstatat(folder, name.constData(), &status, AT_SYMLINK_NOFOLLOW) == 0;
    if (exists && !S_ISREG(status.st_mode))
        return fileError(path, "not a regular file");
    if (exists && !replace)
        return fileError(path, "exists already, expected a new name or force: true");
    const QByteArray draft = ".hermes-" + QUuid::createUuid().toByteArray(QUuid::Id128);
    const Descriptor file(
        ::openat(folder, draft.constData(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644));
    const bool isWritten = file >= 0 && (!exists || ::fchmod(file, status.st_mode & 0777) == 0) &&
                           writeAll(file, bytes) && ::fsync(file) == 0;
    // A file system may not know how not to replace; then it was seen above that there is nothing.
    if (isWritten && (::renameat2(folder, draft.constData(), folder, name.constData(),
                                  replace ? 0 : RENAME_NOREPLACE) == 0 ||
                      ((errno == EINVAL || errno == ENOSYS) &&
                       ::renameat(folder, draft.constData(), folder, name.constData()) == 0)))
        return syncNamesIn(parent);
    const Error error = failed();
    ::unlinkat(folder, draft.constData(), 0);
    return error;
}

Result<void> checkReplaceable(const QString &path) {
    struct stat status {};
    if (::stat(QFile::encodeName(path).constData(), &status) != 0 || S_ISREG(status.st_mode))
        return {};
    return fileError(path, whereLinked(path, realPath(path)) + "not a regular file");
}

Result<void> openOwnFile(QFile &file, const QString &path, bool make) {
    Descriptor opened(::open(QFile::encodeName(path).constData(),
                             O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC | (make ? O_CREAT : 0),
                             0644));
    struct stat status {};
    if (opened < 0 || ::fstat(opened, &status) != 0)
        return fileError(path, errno == ELOOP ? "it is a link" : "cannot be opened: " + qt_error_string());
    if (!S_ISREG(status.st_mode) || status.st_nlink > 1)
        return fileError(path, "not a regular file, or one with another name");
    file.setFileName(path);
    file.open(opened.release(), QIODevice::ReadWrite, QFileDevice::AutoCloseHandle);
    return {};
}

} // namespace hermes
