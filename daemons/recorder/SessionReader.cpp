#include "daemons/recorder/SessionReader.h"

#include "daemons/recorder/SessionList.h"

#include "common/recording/DiskError.h"
#include "common/recording/Sidecar.h"

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
    reader.summary_.name = place.dirName();
    for (const QString &name : place.entryList({"*.json"}, QDir::Files | QDir::NoSymLinks, QDir::Name))
        if (const auto sidecar = Sidecar::read(place.filePath(name)))
            reader.addSidecar(*sidecar);
    if (reader.parts_.empty())
        return diskError(reader.folder_ + ": found no sidecar of a recording, expected some", reader.folder_);
    for (const QString &name :
         place.entryList({recorderName + "-*.mcap"}, QDir::Files | QDir::NoSymLinks, QDir::Name))
        reader.files_.append(place.filePath(name));
    return reader;
}

void SessionReader::addSidecar(const QJsonObject &sidecar) {
    SessionPart part;
    part.daemon = sidecar["logger"].toString();
    part.state = sidecar["ended"].toString("recording");
    part.bytes = sidecar["bytes"].toDouble();
    for (const auto &[to, counts] : {std::pair(&part.counts, sidecar["counts"].toObject()),
                                     std::pair(&part.losses, sidecar["losses"].toObject())})
        for (auto count = counts.begin(); count != counts.end(); ++count)
            to->insert(count.key(), count->toDouble());
    part.problem = sidecar["error"].toString();
    if (part.problem.isEmpty() && part.state != "recording")
        part.problem = RecordedPart{{}, sidecar}.fault();
    const double start = sidecar["start"].toDouble();
    const bool isRecorder = part.daemon == recorderName;
    if (isRecorder)
        lost_ = part.losses;
    start_ = isRecorder || start_ == 0 ? start : start_;
    summary_.start = parts_.empty() ? start : std::min(summary_.start, start);
    summary_.session = sidecar["session"].toString();
    summary_.bytes += part.bytes;
    if (part.state == "recording")
        summary_.end.reset();
    else if (parts_.empty() || summary_.end)
        summary_.end = std::max(summary_.end.value_or(0), sidecar["end"].toDouble());
    summary_.daemons.append(part.daemon);
    if (!part.problem.isEmpty())
        summary_.problems.append(part.daemon + ": " + part.problem);
    parts_.push_back(part);
}

void SessionReader::note(const QString &problem) {
    if (!problem.isEmpty() && !problems_.contains(problem))
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
            const auto channel = reader.channels().find(message->channel);
            if (channel == reader.channels().end())
                continue;
            const auto schema = reader.schemas().find(channel->second.schema);
            const SessionMessage recorded{QString::fromStdString(channel->second.topic),
                                          1e-9 * double(std::int64_t(message->logTime_ns) - start_ns),
                                          1e-9 * double(message->publishTime_ns),
                                          *message,
                                          channel->second,
                                          schema == reader.schemas().end() ? nullptr : &schema->second};
            if (recorded.t_s > to_s || (stop_ && *stop_))
                break;
            take(recorded);
        }
        note(QString::fromStdString(reader.problem()));
    }
}

} // namespace hermes::recorder
