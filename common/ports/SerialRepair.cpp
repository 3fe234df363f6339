// How a recording of ports that was cut off is mended.
#include "common/files/NamedFile.h"
#include "common/ports/SerialIndex.h"
#include "common/ports/SerialRecorder.h"
#include "common/recording/DiskError.h"

#include <QFile>

#include <algorithm>

namespace hermes {

using namespace serialindex;

namespace {

/// What a repaired port holds.
struct Contents {
    double bytes = 0, chunks = 0;
    std::optional<Moment> first, last;
};

Error failed(const QFile &file) {
    return diskError(QString("%1: %2").arg(file.fileName(), file.errorString()), file.fileName());
}

std::optional<Record> recordAt(QFile &index, qint64 number) {
    unsigned char bytes[recordSize];
    if (!index.seek(qint64(headerSize) + number * qint64(recordSize)) ||
        index.read(reinterpret_cast<char *>(bytes), recordSize) != qint64(recordSize))
        return std::nullopt;
    return decode(bytes);
}

Result<Contents> repairPort(const QString &base) {
    Contents contents;
    const qint64 size = QFileInfo(base + ".raw").size();
    contents.bytes = double(size);
    QFile index;
    if (const Result<void> opened = openOwnFile(index, base + ".index"); !opened)
        return opened.error();
    const QByteArray expected(reinterpret_cast<const char *>(header.data()), int(header.size()));
    if (index.read(headerSize) != expected)
        return diskError(index.fileName() +
                             ": \"HERMESIX\" version 1 expected at its beginning, as of an index",
                         index.fileName());
    qint64 records = (index.size() - qint64(headerSize)) / qint64(recordSize);
    while (records > 0) { // written before their bytes, which never came
        const auto record = recordAt(index, records - 1);
        if (!record)
            return failed(index);
        if (record->offset < quint64(size))
            break;
        --records;
    }
    if (!index.resize(qint64(headerSize) + records * qint64(recordSize)))
        return failed(index);
    contents.chunks = double(records);
    if (records > 0) {
        contents.first = recordAt(index, 0)->arrival;
        contents.last = recordAt(index, records - 1)->arrival;
    }
    return contents;
}

/// The number of events and marks that stay.
Result<QJsonObject> repairEvents(const QString &path) {
    QFile file;
    if (!QFile::exists(path)) // cut off as it was made
        return QJsonObject{{"events", 0}, {"marks", 0}};
    if (const Result<void> opened = openOwnFile(file, path); !opened)
        return opened.error();
    double events = 0, marks = 0;
    qint64 whole = 0;
    for (QByteArray line = file.readLine(); line.endsWith('\n'); line = file.readLine()) {
        whole += line.size();
        ++events;
        marks += line.contains("\"event\":\"mark\"");
    }
    if (!file.resize(whole))
        return failed(file);
    return QJsonObject{{"events", events}, {"marks", marks}};
}

} // namespace

Result<void> SerialRecorder::repair(const RecordingPlan &plan, QJsonObject &sidecar) {
    const QString base = plan.folder + '/' + plan.prefix + '-';
    QJsonArray files;
    double bytes = 0, chunks = 0, end = sidecar.value("start").toDouble();
    for (const QJsonValue &entry : sidecar.value("files").toArray()) {
        QJsonObject file = entry.toObject();
        const QString port = file.value("port").toString();
        if (port.contains('/'))
            return diskError(QString("%1: a port \"%2\" cannot be of this recording").arg(plan.folder, port),
                             plan.folder);
        const Result<Contents> contents = repairPort(base + port);
        if (!contents)
            return contents.error();
        file.insert("bytes", contents->bytes);
        file.insert("chunks", contents->chunks);
        if (contents->first) {
            file.insert("first_stamp", contents->first->stamp());
            file.insert("last_stamp", contents->last->stamp());
            end = std::max(end, contents->last->stamp());
        }
        files.append(file);
        bytes += contents->bytes;
        chunks += contents->chunks;
    }
    const Result<QJsonObject> events = repairEvents(base + "events.jsonl");
    if (!events)
        return events.error();
    QJsonObject counts = *events;
    counts.insert("bytes", bytes);
    counts.insert("chunks", chunks);
    sidecar.insert("files", files);
    sidecar.insert("bytes", bytes);
    sidecar.insert("counts", counts);
    sidecar.insert("end", end);
    return {};
}

} // namespace hermes
