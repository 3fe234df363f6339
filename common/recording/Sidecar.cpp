#include "common/recording/Sidecar.h"

#include "common/files/NamedFile.h"
#include "common/recording/DiskError.h"
#include "common/recording/FileSync.h"
#include "protocol/wire/Fields.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonDocument>

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace hermes {

namespace {

constexpr qint64 largest = 16 * 1024 * 1024; // a recording of a year has tens of thousands of files
constexpr double longestRecording_s = 1e7;   // four months

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

double Sidecar::duration(const QJsonObject &content) {
    const bool hasMono = content["start_mono"].isDouble() && content["end_mono"].isDouble();
    const QString clock = hasMono ? "_mono" : "";
    const double length = content["end" + clock].toDouble() - content["start" + clock].toDouble();
    return std::clamp(length, 0.0, longestRecording_s);
}

RecordingEntry Sidecar::entry(const QString &path, const Result<QJsonObject> &sidecar) {
    const QDir folder = QFileInfo(path).dir();
    RecordingEntry entry;
    entry.name = folder.dirName();
    if (!sidecar) {
        entry.error = sidecar.error().message;
        return entry;
    }
    QJsonObject content = *sidecar;
    content.insert("name", entry.name);
    content.remove("error"); // that ended it
    const int files = content.take("files").toArray().size();
    ReadReport report;
    if (const auto told = readMessage<RecordingEntry>(WireValue(content), report))
        entry = *told;
    else
        entry.error = path + ": " + report.text();
    entry.folder = folder.absolutePath();
    entry.files = files;
    entry.duration_s = content["ended"].isString() ? std::optional(duration(content)) : std::nullopt;
    QStringList &loggers = entry.loggers.emplace();
    for (const QFileInfo &file : folder.entryInfoList({"*.json"}, QDir::Files, QDir::Name))
        if (const Result<QJsonObject> other = read(file.absoluteFilePath()))
            loggers.append(other->value("logger").toString());
    return entry;
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
