#include "daemons/seriallogger/SerialMarks.h"

#include "common/recording/DiskError.h"

#include <QDir>
#include <QFile>
#include <QJsonDocument>

namespace hermes::seriallogger {
namespace {

constexpr std::size_t maxMarks = 1000;
constexpr qint64 longestLine = 1 << 14; // bytes; a text has at most 1000 characters

} // namespace

Result<std::vector<RecordedMark>> readMarks(const StoredRecording &recording) {
    QFile file(QDir(recording.folder).filePath("seriallogger-events.jsonl"));
    std::vector<RecordedMark> marks;
    if (!file.exists()) // cut off as it was made
        return marks;
    if (!file.open(QIODevice::ReadOnly))
        return diskError(file.fileName() + ": cannot be read: " + file.errorString(), file.fileName());
    const double startMono_s = recording.sidecar.value("start_mono").toDouble();
    while (!file.atEnd() && marks.size() < maxMarks) {
        const QJsonObject event = QJsonDocument::fromJson(file.readLine(longestLine)).object();
        if (event["event"] != QJsonValue("mark") || !event["text"].isString())
            continue;
        const double stamp = event["stamp"].toDouble();
        const double t_s =
            event["mono"].isDouble() ? event["mono"].toDouble() - startMono_s : stamp - recording.start_s;
        marks.push_back({t_s, stamp, event["text"].toString()});
    }
    return marks;
}

} // namespace hermes::seriallogger
