#include "daemons/recorder/SessionReader.h"

#include "common/recording/DiskError.h"
#include "common/recording/Sidecar.h"
#include "common/recording/StoredRecording.h"

#include <QDir>
#include <QJsonObject>
#include <QRegularExpression>
#include <algorithm>

namespace hermes::recorder {
namespace {

const QString recorderName = QStringLiteral("recorder");

} // namespace

QString topicPattern(const QString &text) {
    return QRegularExpression::anchoredPattern(QRegularExpression::escape(text).replace("\\*", ".*"));
}

WireValue SessionMessage::data() const {
    WireError error;
    return WireValue::parse(QByteArray::fromRawData(raw.data.data(), int(raw.data.size())), &error)
        .value_or(WireValue());
}

Result<SessionReader> SessionReader::open(const QString &folder, const std::atomic<bool> *stop) {
    SessionReader reader;
    reader.stop_ = stop;
    const QDir place(folder);
    reader.folder_ = place.absolutePath();
    for (const QFileInfo &file :
         place.entryInfoList({"*.json"}, QDir::Files | QDir::NoSymLinks, QDir::Name)) {
        const Result<QJsonObject> sidecar = Sidecar::read(file.absoluteFilePath());
        if (!sidecar)
            continue;
        RecordedPart part;
        part.member.name = (*sidecar)["logger"].toString();
        part.entry = Sidecar::entry(file.absoluteFilePath(), sidecar);
        part.error = (*sidecar)["error"].toString();
        if (part.entry.error) {
            reader.note(*part.entry.error);
            continue;
        }
        reader.session_.id = part.entry.session.value_or(QString());
        const bool isRecorder = part.member.name == recorderName;
        if (isRecorder)
            reader.lost_ = part.entry.losses.value_or(NamedCounts());
        if (isRecorder || reader.session_.parts.empty())
            reader.start_ = part.entry.start.value_or(0);
        reader.session_.add(part);
        if (const auto whole = StoredRecording{reader.folder_, *sidecar}.isWhole(); !whole && !part.goesOn())
            reader.note(whole.error().message);
    }
    if (reader.session_.parts.empty())
        return diskError(reader.folder_ + ": found no sidecar of a recording, expected some", reader.folder_);
    reader.session_.name = place.dirName();
    for (const QFileInfo &file :
         place.entryInfoList({recorderName + "-*.mcap"}, QDir::Files | QDir::System, QDir::Name))
        if (file.isSymLink())
            reader.note(file.absoluteFilePath() + ": it is a link, and is not read");
        else
            reader.files_.append(file.absoluteFilePath());
    return reader;
}

void SessionReader::note(const QString &problem) {
    if (!problems_.contains(problem))
        problems_.append(problem);
}

double SessionReader::bytes() const {
    double sum = 0;
    for (const QString &path : files_)
        sum += double(QFileInfo(path).size());
    return sum;
}

void SessionReader::read(const Wanted &wanted, const Take &take, double from_s, double to_s) {
    for (const QString &path : files_) {
        if (isStopped())
            return;
        auto opened = mcap::Reader::open(path.toStdString());
        if (!opened) {
            note(QString::fromStdString(opened.error()));
            continue;
        }
        mcap::Reader &reader = *opened;
        reader.select([&](const mcap::Channel &channel) {
            return !wanted || wanted(QString::fromStdString(channel.topic));
        });
        const double from_ns = 1e9 * (start_ + from_s);
        if (from_s != 0)
            reader.seek(std::uint64_t(std::clamp(from_ns, 0.0, 9e18)));
        const auto start_ns = std::int64_t(std::clamp(start_ * 1e9, 0.0, 9e18));
        while (const auto message = reader.next()) {
            const mcap::Channel &channel = reader.channels().at(message->channel);
            const auto schema = reader.schemas().find(channel.schema);
            const SessionMessage recorded{QString::fromStdString(channel.topic),
                                          1e-9 * double(std::int64_t(message->logTime_ns) - start_ns),
                                          1e-9 * double(message->publishTime_ns),
                                          *message,
                                          channel,
                                          schema == reader.schemas().end() ? nullptr : &schema->second};
            if (recorded.t_s > to_s || isStopped())
                break;
            take(recorded);
        }
        if (!reader.problem().empty())
            note(path + ": " + QString::fromStdString(reader.problem()));
    }
}

} // namespace hermes::recorder
