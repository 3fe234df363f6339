#include "common/files/SavedFile.h"

#include "common/platform/PrivateFiles.h"

#include <QJsonObject>

namespace hermes {

Result<void> SavedFile::sync() {
    // QSaveFile::commit() alone does not tell that the last piece found no room.
    return flush() && error() == NoError && syncToDisk(handle()) ? Result<void>() : failure();
}

Result<void> SavedFile::commit() {
    if (const Result<void> synced = sync(); !synced)
        return synced;
    return QSaveFile::commit() ? Result<void>() : failure();
}

// A disk with too little room takes a part, without an error: that comes with the rest.
qint64 SavedFile::writeData(const char *data, qint64 size) {
    qint64 done = 0, more = 1;
    for (; done < size && more > 0; done += std::max<qint64>(0, more))
        more = QSaveFile::writeData(data + done, size - done);
    return more < 0 ? -1 : done;
}

Error SavedFile::failure() const {
    return Error(ErrorCode::InputOutput,
                 QStringLiteral("%1: cannot be written: %2")
                     .arg(fileName(), error() == NoError ? qt_error_string() : errorString()),
                 QJsonObject{{QStringLiteral("path"), fileName()}});
}

Result<void> saveFile(const QString &path, const QByteArray &bytes) {
    SavedFile file(path);
    Result<void> done = file.begin();
    if (done) {
        file.write(bytes);
        done = file.commit();
    }
    return done;
}

} // namespace hermes
