#include "common/ports/SerialRecorder.h"

#include "common/recording/DiskError.h"

#include <QJsonDocument>

#include <chrono>

namespace hermes {

namespace {

constexpr std::chrono::milliseconds collectPeriod{20}; // what the end of the process may cost
constexpr int maxEventBytes = 1 << 20;

} // namespace

void SerialRecorder::setPorts(std::vector<Port> ports) {
    entries_.clear();
    for (Port &port : ports) {
        entries_.push_back(std::make_unique<Entry>());
        entries_.back()->port = std::move(port);
    }
}

Result<void> SerialRecorder::begin(const RecordingPlan &plan) {
    end();
    if (const std::optional<Error> failure = openFiles(plan))
        return *failure;
    const std::lock_guard<std::mutex> lock(mutex_);
    plan_ = plan;
    events_.clear();
    const QJsonValue counts = plan.earlier["counts"];
    eventCount_ = quint64(counts["events"].toDouble());
    markCount_ = quint64(counts["marks"].toDouble());
    eventsLost_ = diskLost_ = 0;
    error_.reset();
    stopping_ = false;
    recording_ = true;
    publish();
    for (const auto &entry : entries_)
        entry->port.queue->open();
    thread_ = std::thread([this] { run(); });
    return {};
}

std::optional<Error> SerialRecorder::openFiles(const RecordingPlan &plan) {
    const QString base = plan.folder + '/' + plan.prefix + '-', events = base + "events.jsonl";
    const bool goesOn = !plan.earlier.isEmpty();
    for (const auto &entry : entries_) {
        if (!entry->file.open(base + entry->port.name, goesOn, plan.toItsClock_ns))
            return diskError(entry->file.error(), entry->file.failedPath());
    }
    for (const QJsonValue &file : plan.earlier["files"].toArray())
        for (const auto &entry : entries_)
            if (entry->port.name == file["port"].toString() &&
                double(entry->file.bytes()) < file["bytes"].toDouble())
                return diskError(
                    QString("%1: it has %2 bytes, and %3 were recorded; nothing is written behind them")
                        .arg(entry->file.path())
                        .arg(entry->file.bytes())
                        .arg(file["bytes"].toDouble(), 0, 'f', 0),
                    entry->file.path());
    if (!(goesOn ? eventFile_.resume(events) : eventFile_.create(events)))
        return diskError(eventFile_.error(), eventFile_.path());
    return std::nullopt;
}

void SerialRecorder::end() {
    for (const auto &entry : entries_)
        entry->port.queue->close();
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        stopping_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable())
        thread_.join();
    for (const auto &entry : entries_)
        entry->file.close();
    eventFile_.close();
}

bool SerialRecorder::note(const QString &event, const QJsonObject &details, const Moment &when) {
    return addEvent(event, details, when, false);
}

bool SerialRecorder::addEvent(const QString &event, QJsonObject line, const Moment &when, bool atEnd) {
    const std::lock_guard<std::mutex> lock(mutex_);
    line.insert("event", event);
    line.insert("stamp", when.stamp());
    line.insert("mono", double(when.mono_ns + plan_.toItsClock_ns) * 1e-9);
    const QByteArray text = QJsonDocument(line).toJson(QJsonDocument::Compact) + '\n';
    if (!recording_ || (stopping_ && !atEnd))
        return false;
    if (events_.size() + text.size() > maxEventBytes) {
        ++eventsLost_;
        return false;
    }
    events_ += text;
    ++eventCount_;
    markCount_ += event == "mark";
    return true;
}

void SerialRecorder::run() {
    bool writing = true;
    bool stopping = false;
    while (writing && !stopping) {
        {
            std::unique_lock<std::mutex> lock(mutex_);
            wake_.wait_for(lock, collectPeriod, [this] { return stopping_; });
            stopping = stopping_;
        }
        writing = writePorts();
        writing = writeEvents() && writing;
        const std::lock_guard<std::mutex> lock(mutex_);
        publish();
    }
    for (const auto &entry : entries_) // what came meanwhile has no place
        entry->port.queue->close();
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto &entry : entries_) {
        entry->port.queue->take(entry->batch);
        diskLost_ += entry->batch.bytes.size();
    }
    recording_ = false;
}

bool SerialRecorder::writePorts() {
    bool fine = true;
    for (const auto &entry : entries_) {
        entry->port.queue->take(entry->batch);
        const quint64 begin = entry->file.bytes();
        if (!entry->file.write(entry->batch)) {
            fine = fail(entry->file.error(), entry->file.failedPath());
            const std::lock_guard<std::mutex> lock(mutex_);
            diskLost_ += begin + entry->batch.bytes.size() - entry->file.bytes();
        }
        noteLosses(*entry, begin);
    }
    return fine;
}

void SerialRecorder::noteLosses(const Entry &entry, quint64 begin) {
    const auto tell = [&](quint64 offset, quint64 bytes, const Moment &when) {
        addEvent("lost", {{"port", entry.port.name}, {"offset", double(offset)}, {"bytes", double(bytes)}},
                 when, true);
    };
    quint64 offset = begin;
    for (const ChunkBatch::Chunk &chunk : entry.batch.chunks) {
        if (chunk.lostBefore > 0)
            tell(offset, chunk.lostBefore, chunk.arrival);
        offset += chunk.size;
    }
    if (entry.batch.lostAtEnd > 0)
        tell(offset, entry.batch.lostAtEnd, Moment::now());
}

bool SerialRecorder::writeEvents() {
    QByteArray lines;
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        lines.swap(events_);
    }
    const quint64 before = eventFile_.size();
    if (lines.isEmpty() || eventFile_.append(lines.constData(), std::size_t(lines.size())))
        return true;
    const QString why = eventFile_.error();
    eventFile_.truncate(before); // no half lines
    return fail(why, eventFile_.path());
}

bool SerialRecorder::fail(const QString &message, const QString &path) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!error_)
        error_ = diskError(message, path);
    return false;
}

void SerialRecorder::publish() {
    for (const auto &entry : entries_) {
        entry->bytes = entry->file.bytes();
        entry->chunks = entry->file.chunks();
        entry->first = entry->file.first();
        entry->last = entry->file.last();
    }
}

RecordingState SerialRecorder::state() const {
    RecordingState state;
    double queueLost = 0, chunks = 0;
    const std::lock_guard<std::mutex> lock(mutex_);
    QMap<QString, QJsonObject> earlier; // by port
    for (const QJsonValue &file : plan_.earlier["files"].toArray())
        earlier[file["port"].toString()] = file.toObject();
    for (const auto &entry : entries_) {
        QJsonObject file = earlier.take(entry->port.name);
        const QJsonObject about = entry->port.about ? entry->port.about() : QJsonObject();
        for (auto member = about.begin(); member != about.end(); ++member)
            file[member.key()] = *member;
        file["name"] = plan_.prefix + '-' + entry->port.name + ".raw";
        file["port"] = entry->port.name;
        file["url"] = entry->port.url;
        file["bytes"] = double(entry->bytes);
        file["chunks"] = double(entry->chunks);
        if (entry->first) {
            file["first_stamp"] = file["first_stamp"].toDouble(entry->first->stamp());
            file["last_stamp"] = entry->last->stamp();
        }
        state.files.append(file);
        queueLost += double(entry->port.queue->lost());
    }
    for (const QJsonObject &file : qAsConst(earlier)) // of ports that are no longer there
        state.files.append(file);
    for (const QJsonValue &file : qAsConst(state.files)) {
        state.bytes += file["bytes"].toDouble();
        chunks += file["chunks"].toDouble();
    }
    state.path = plan_.folder;
    state.counts = {{"bytes", state.bytes},
                    {"chunks", chunks},
                    {"events", double(eventCount_)},
                    {"marks", double(markCount_)}};
    state.losses = {
        {"queue_bytes", queueLost}, {"disk_bytes", double(diskLost_)}, {"events", double(eventsLost_)}};
    state.addEarlierLosses(plan_.earlier);
    state.error = error_;
    return state;
}

} // namespace hermes
