#include "daemons/velodynelogger/RecordFolder.h"

#include "common/recording/SessionFolder.h"

#include <QDir>

namespace hermes::velodynelogger {

Result<QString> RecordFolder::newFile(const QString &name, const QString &suffix) const {
    const Result<void> fine = checkName("name", name);
    if (!fine)
        return fine.error();
    const QDir folder(path_);
    if (!folder.mkpath("."))
        return diskError(path_ + ": the folder for recordings cannot be made", path_);
    const QString path = folder.absoluteFilePath(name.endsWith('.' + suffix) ? name : name + '.' + suffix);
    if (QFileInfo::exists(path))
        return diskError(path + ": it exists already; recordings are not overwritten", path);
    return path;
}

} // namespace hermes::velodynelogger
