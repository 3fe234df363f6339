#include "daemons/velodynelogger/TurnFile.h"

#include "common/files/Folder.h"
#include "common/recording/DiskError.h"
#include "common/recording/SessionFolder.h"

#include <QDir>
#include <QTemporaryFile>

#include <unistd.h>

namespace hermes::velodynelogger {

namespace {

constexpr std::size_t chunkBytes = 1 << 16;

/// Everything is on the disk when this says true.
bool writeAll(QFile &file, const velodyne::Turn &turn, TurnFormat format) {
    std::string text = turnHeader(turn, format);
    const auto flush = [&] {
        const bool written = file.write(text.data(), qint64(text.size())) == qint64(text.size());
        text.clear();
        return written;
    };
    for (const velodyne::Point &point : turn.points) {
        appendPoint(text, turn, point, format);
        if (text.size() >= chunkBytes && !flush())
            return false;
    }
    return flush() && file.flush() && ::fsync(file.handle()) == 0;
}

} // namespace

Result<QString> newTurnFile(const QString &folder, const QString &name, const QString &suffix) {
    if (const Result<void> fine = checkName("name", name); !fine)
        return fine.error();
    if (const Result<void> made = makeFolder(folder); !made)
        return diskError(made.error().message, folder);
    const QString path =
        QDir(folder).absoluteFilePath(name.endsWith('.' + suffix) ? name : name + '.' + suffix);
    if (QFileInfo::exists(path))
        return diskError(path + ": it exists already; recordings are not overwritten", path);
    return path;
}

Result<void> writeTurn(const QString &path, const velodyne::Turn &turn, TurnFormat format) {
    QTemporaryFile file(path + ".part-XXXXXX");
    const auto failed = [&] { return diskError(path + ": cannot be written: " + file.errorString(), path); };
    if (!file.open() || !writeAll(file, turn, format))
        return failed();
    file.setPermissions(QFile::ReadOwner | QFile::WriteOwner | QFile::ReadGroup | QFile::ReadOther);
    file.setAutoRemove(false);
    if (!file.rename(path)) { // which does not overwrite
        const Error error = failed();
        file.remove();
        return error;
    }
    return {};
}

} // namespace hermes::velodynelogger
