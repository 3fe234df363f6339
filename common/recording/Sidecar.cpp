#include "common/recording/Sidecar.h"

#include "common/files/NamedFile.h"
#include "common/recording/DiskError.h"
#include "common/recording/FileSync.h"

#include <QFile>
#include <QFileInfo>
#include <QJsonDocument>

#include <cstdio>
#include <unistd.h>

namespace hermes {

namespace {

constexpr qint64 largest = 16 * 1024 * 1024; // a recording of a year has tens of thousands of files

/// Always the same, so that a crash leaves one at most.
QString draftPath(const QString &path) {
    const QFileInfo file(path);
    return file.path() + "/." + file.fileName() + ".new";
}

} // namespace

Result<QJsonObject> Sidecar::read(const QString &path) {
    const Result<QByteArray> text = readNamedFile(path, {QFileInfo(path).path()}, largest);
    if (!text)
        return text.error();
    QJsonParseError problem;
    const QJsonObject content = QJsonDocument::fromJson(*text, &problem).object();
    if (problem.error != QJsonParseError::NoError)
        return diskError(
            QString("%1: at byte %2: %3").arg(path).arg(problem.offset).arg(problem.errorString()), path);
    if (content.value("format").toString() != format)
        return diskError(path + ": \"format\": \"" + format + "\" expected, as of a sidecar", path);
    return content;
}

Result<void> Sidecar::write(const QString &path, const QJsonObject &content, bool durable,
                            const QString &room) {
    const QByteArray bytes = QJsonDocument(content).toJson();
    const QString draft = room.isEmpty() ? draftPath(path) : room;
    QFile file;
    const auto failed = [&](const QString &why) {
        QFile::remove(draft);
        return diskError(path + ": cannot be written: " + why, path);
    };
    // Nothing of it is given back before it is written; but what somebody has put in its place goes.
    Result<void> opened = openOwnFile(file, draft, true);
    if (!opened && QFile::remove(draft))
        opened = openOwnFile(file, draft, true);
    if (!opened)
        return failed(opened.error().message);
    if (file.write(bytes) != bytes.size() || !file.flush() || !file.resize(bytes.size()) ||
        (durable && ::fsync(file.handle()) != 0))
        return failed(file.errorString());
    file.close();
    if (std::rename(QFile::encodeName(draft).constData(), QFile::encodeName(path).constData()) != 0)
        return failed(qt_error_string());
    if (durable)
        syncFolder(QFileInfo(path).path());
    return {};
}

} // namespace hermes
