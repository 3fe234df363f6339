#include "daemons/seriallogger/SerialRecorder.h"

#include "common/recording/DiskError.h"
#include "daemons/seriallogger/SerialRepair.h"

#include <QJsonDocument>

#include <chrono>

namespace hermes::seriallogger {

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
    eventCount_ = markCount_ = eventsLost_ = diskLost_ = 0;
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
    const QString base = plan.folder + '/' + plan.prefix + '-';
    for (const auto &entry : entries_) {
        if (!entry->file.create(base + entry->port.name))
            return diskError(entry->file.error(), entry->file.failedPath());
    }
    if (!eventFile_.create(base + "events.jsonl"))
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
    line.insert("event", event);
    line.insert("stamp", when.stamp());
    line.insert("mono", when.mono());
    const QByteArray text = QJsonDocument(line).toJson(QJsonDocument::Compact) + '\n';
    const std::lock_guard<std::mutex> lock(mutex_);
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
    for (const auto &entry : entries_) {
        QJsonObject file{{"name", plan_.prefix + '-' + entry->port.name + ".raw"},
                         {"port", entry->port.name},
                         {"url", entry->port.url},
                         {"bytes", double(entry->bytes)},
                         {"chunks", double(entry->chunks)}};
        if (entry->first) {
            file.insert("first_stamp", entry->first->stamp());
            file.insert("last_stamp", entry->last->stamp());
        }
        state.files.append(file);
        state.bytes += double(entry->bytes);
        chunks += double(entry->chunks);
        queueLost += double(entry->port.queue->lost());
    }
    state.path = plan_.folder;
    state.counts = {{"bytes", state.bytes},
                    {"chunks", chunks},
                    {"events", double(eventCount_)},
                    {"marks", double(markCount_)}};
    state.losses = {
        {"queue_bytes", queueLost}, {"disk_bytes", double(diskLost_)}, {"events", double(eventsLost_)}};
    state.error = error_;
    return state;
}

Result<void> SerialRecorder::repair(const RecordingPlan &plan, QJsonObject &sidecar) {
    return repairSerialRecording(plan, sidecar);
}

} // namespace hermes::seriallogger
