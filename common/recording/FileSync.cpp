#include "common/recording/FileSync.h"

#include "common/recording/DiskError.h"

#include <QDir>

#include <fcntl.h>
#include <unistd.h>

namespace hermes {
namespace {

Result<void> sync(const QString &path, int (*how)(int)) {
    const int file = ::open(QFile::encodeName(path).constData(), O_RDONLY | O_CLOEXEC);
    const bool done = file >= 0 && how(file) == 0;
    const QString why = qt_error_string();
    if (file >= 0)
        ::close(file);
    return done ? Result<void>() : diskError(path + ": cannot be written to the disk: " + why, path);
}

} // namespace

Result<void> syncFile(const QString &path) {
    return sync(path, ::fdatasync);
}

void syncFolder(const QString &path) {
    sync(path, ::fsync);
}

Result<void> FileSync::run(const QString &folder, const QString &logger) {
    std::map<QString, qint64> sizes;
    bool isNew = false;
    for (const QFileInfo &file : QDir(folder).entryInfoList({logger + "-*"}, QDir::Files)) {
        const QString path = file.absoluteFilePath();
        const auto known = sizes_.find(path);
        isNew = isNew || known == sizes_.end();
        sizes[path] = file.size();
        if (known != sizes_.end() && known->second == file.size())
            continue;
        const Result<void> synced = syncFile(path);
        if (!synced && QFile::exists(path)) // else it was removed meanwhile
            return synced;
    }
    sizes_ = std::move(sizes);
    if (isNew)
        syncFolder(folder);
    return {};
}

} // namespace hermes
