#include "daemons/velodynelogger/RecordFolder.h"

#include "common/files/Folder.h"
#include "common/recording/SessionFolder.h"

#include <QDir>

namespace hermes::velodynelogger {

Result<QString> RecordFolder::newFile(const QString &name, const QString &suffix) const {
    const Result<void> fine = checkName("name", name);
    if (!fine)
        return fine.error();
    if (const Result<void> made = makeFolder(path_); !made)
        return diskError(made.error().message, path_);
    const QString path =
        QDir(path_).absoluteFilePath(name.endsWith('.' + suffix) ? name : name + '.' + suffix);
    if (QFileInfo::exists(path))
        return diskError(path + ": it exists already; recordings are not overwritten", path);
    return path;
}

} // namespace hermes::velodynelogger
