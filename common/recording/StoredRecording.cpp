#include "common/recording/StoredRecording.h"

#include "common/files/NamedFile.h"
#include "common/recording/DiskError.h"
#include "common/recording/SessionFolder.h"
#include "common/recording/Sidecar.h"

#include <QDir>
#include <QJsonArray>

namespace hermes {

namespace {

constexpr double latest_s = 4294967295; // what the stamps of the files can hold

} // namespace

Result<StoredRecording> StoredRecording::find(const QString &root, const QString &name,
                                              const QString &logger) {
    if (const Result<void> fine = checkName("recording", name); !fine)
        return fine.error();
    StoredRecording recording;
    recording.folder = QDir(root).absoluteFilePath(name);
    const QString path = Sidecar::path(recording.folder, logger);
    const Result<QJsonObject> sidecar = Sidecar::read(path);
    if (!sidecar)
        return sidecar.error();
    if (!sidecar->value("ended").isString())
        return Error(ErrorCode::NotReady, path + ": the recording has not ended; record.stop ends it");
    recording.sidecar = *sidecar;
    recording.start_s = sidecar->value("start").toDouble(-1);
    if (!(recording.start_s >= 0 && recording.start_s <= latest_s))
        return diskError(path + ": \"start\": seconds since the epoch expected", path);
    recording.length_s = Sidecar::duration(*sidecar);
    return recording;
}

Result<QStringList> StoredRecording::files() const {
    QStringList paths;
    for (const QJsonValue &file : sidecar.value("files").toArray()) {
        const QString name = file.toObject().value("name").toString();
        if (name.isEmpty() || name.contains('/') || name.startsWith('.'))
            return diskError(QString("%1: a file \"%2\" cannot be of this recording").arg(folder, name),
                             folder);
        const Result<QString> found = findNamedFile(QDir(folder).filePath(name), {folder}, 0);
        if (!found)
            return found.error();
        paths << *found;
    }
    return paths;
}

Result<void> StoredRecording::isWhole() const {
    for (const QJsonValue &file : sidecar.value("files").toArray()) {
        const QString path = QDir(folder).filePath(file["name"].toString());
        const double recorded = file["bytes"].toDouble(); // whatever stands there
        const qint64 size = QFileInfo(path).size();
        if (double(size) < recorded)
            return diskError(QString("%1: it has %2 bytes, and %3 were recorded; the others are missing")
                                 .arg(path)
                                 .arg(size)
                                 .arg(recorded, 0, 'f', 0),
                             path);
    }
    return {};
}

} // namespace hermes
