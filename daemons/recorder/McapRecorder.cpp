#include "daemons/recorder/McapRecorder.h"

#include "common/Project.h"
#include "common/Time.h"
#include "common/recording/DiskError.h"
#include "protocol/mcap/Reader.h"

#include <QDir>
#include <chrono>

namespace hermes::recorder {
namespace {

constexpr std::chrono::milliseconds collectPeriod{100};
constexpr double chunkPeriod_s = 0.9; // what a kill may cost, with the time for collecting less than a second
constexpr std::size_t messageBytes = 64; // that one takes beside its content, about

} // namespace

Result<void> McapRecorder::begin(const RecordingPlan &plan) {
    end();
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        plan_ = plan;
        topics_.clear();
        lost_.clear();
        waiting_.clear();
        files_.clear();
        waitingBytes_ = 0;
        messages_ = 0;
        error_.reset();
        stopping_ = false;
    }
    if (!openFile())
        return *error_;
    const std::lock_guard<std::mutex> lock(mutex_);
    takes_ = true;
    thread_ = std::thread([this] { run(); });
    return {};
}

void McapRecorder::end() {
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        stopping_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable())
        thread_.join();
}

int McapRecorder::addTopic(const RecordedTopic &topic) {
    const std::lock_guard<std::mutex> lock(mutex_);
    topics_.push_back(topic);
    lost_.push_back(0);
    return int(topics_.size()) - 1;
}

void McapRecorder::write(const KeptMessage &message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::size_t bytes = std::size_t(message.json.size()) + messageBytes;
    if (!takes_ && !error_) // it has ended in order
        return;
    if (!takes_ || waitingBytes_ + bytes > maxWaiting_) {
        ++lost_[std::size_t(message.topic)];
        return;
    }
    waitingBytes_ += bytes;
    waiting_.push_back(message);
}

void McapRecorder::noteLost(int topic, quint64 messages) {
    const std::lock_guard<std::mutex> lock(mutex_);
    lost_[std::size_t(topic)] += messages;
}

void McapRecorder::run() {
    bool isWriting = true, isStopping = false;
    double chunkBegan = monotonicNow();
    while (isWriting && !isStopping) {
        std::deque<KeptMessage> messages;
        {
            std::unique_lock<std::mutex> lock(mutex_);
            wake_.wait_for(lock, collectPeriod, [this] { return stopping_; });
            isStopping = stopping_;
            takes_ = !isStopping;
            messages.swap(waiting_);
            waitingBytes_ = 0;
        }
        isWriting = writeAll(messages);
        const bool isDue = monotonicNow() - chunkBegan > chunkPeriod_s;
        if (isWriting && isDue) {
            chunkBegan = monotonicNow();
            isWriting = writer_->closeChunk() || fail();
        }
        const std::lock_guard<std::mutex> lock(mutex_);
        files_.back().bytes = file_.size();
    }
    if (isWriting)
        closeFile();
    else
        mendFile();
    const std::lock_guard<std::mutex> lock(mutex_);
    takes_ = false;
    for (const KeptMessage &message : waiting_) // an error has ended it
        ++lost_[std::size_t(message.topic)];
    waiting_.clear();
    writer_.reset();
}

// After an error: what was written is whole, and has its end where there is room for it.
void McapRecorder::mendFile() {
    file_.close();
    const auto mended = mcap::repair(file_.path().toStdString());
    const std::lock_guard<std::mutex> lock(mutex_);
    if (mended && !files_.empty())
        files_.back().bytes = mended->bytes;
}

bool McapRecorder::writeAll(const std::deque<KeptMessage> &messages) {
    quint64 written = 0, here = 0;
    for (const KeptMessage &message : messages) {
        if (isFull() && !(closeFile() && openFile()))
            break;
        const mcap::Message entry{
            channelOf(message.topic), std::uint32_t(message.sequence),
            std::uint64_t(plan_.start.stamp_ns + message.came.mono_ns - plan_.start.mono_ns),
            std::uint64_t(std::clamp(message.stamp, 0.0, 9e9) * 1e9),
            std::string_view(message.json.constData(), std::size_t(message.json.size()))};
        if (writer_->write(entry))
            ++here;
        else if (!file_.error().isEmpty() && !fail())
            break;
        else // it, or what tells of its topic, is larger than a file can hold
            noteLost(message.topic, 1);
        ++written;
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    messages_ += here;
    files_.back().messages += here;
    for (std::size_t i = written; i < messages.size(); ++i)
        ++lost_[std::size_t(messages[i].topic)];
    return !error_;
}

bool McapRecorder::isFull() const {
    return double(writer_->bytes()) > plan_.fileBytes || monotonicNow() - opened_ > plan_.fileSeconds;
}

/// 0: the file has no room for the schema or the channel.
std::uint16_t McapRecorder::channelOf(int topic) {
    const auto known = channels_.constFind(topic);
    if (known != channels_.constEnd())
        return *known;
    RecordedTopic told;
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        told = topics_[std::size_t(topic)];
    }
    const std::string name = told.topic.toStdString();
    const bool hasSchema = !told.schema.isEmpty();
    const std::uint16_t schema =
        hasSchema ? writer_->addSchema(name, "jsonschema", told.schema.toStdString()) : std::uint16_t(0);
    const std::uint16_t channel =
        hasSchema && schema == 0 ? schema : writer_->addChannel(schema, name, "json", told.metadata);
    return *channels_.insert(topic, channel);
}

bool McapRecorder::openFile() {
    const QString name =
        QString("%1-%2.mcap")
            .arg(plan_.prefix)
            .arg(qulonglong(files_.size()) + qulonglong(plan_.earlierFiles()) + 1, 4, 10, QChar('0'));
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        files_.push_back({name, 0, 0});
    }
    channels_.clear();
    opened_ = monotonicNow();
    if (!file_.create(plan_.folder + '/' + name))
        return fail();
    writer_ = std::make_unique<mcap::Writer>(
        [this](std::string_view bytes) { return file_.append(bytes.data(), bytes.size()); },
        "hermes " + projectVersion().toStdString());
    return true;
}

bool McapRecorder::closeFile() {
    const bool isWhole = writer_->finish() || fail();
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        files_.back().bytes = file_.size();
    }
    file_.close();
    return isWhole;
}

bool McapRecorder::fail() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!error_)
        error_ = diskError(file_.error(), file_.path());
    return false;
}

RecordingState McapRecorder::state() const {
    RecordingState state;
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const File &file : files_) {
        state.files.append(QJsonObject{
            {"name", file.name}, {"bytes", double(file.bytes)}, {"messages", double(file.messages)}});
        state.bytes += double(file.bytes);
    }
    state.path = files_.empty() ? plan_.folder : plan_.folder + '/' + files_.back().name;
    state.counts = {{"messages", double(messages_)}, {"topics", double(topics_.size())}};
    for (std::size_t topic = 0; topic < topics_.size(); ++topic)
        if (lost_[topic] > 0)
            state.losses[topics_[topic].topic] += double(lost_[topic]);
    state.addEarlier(plan_.earlier);
    state.counts["topics"] = double(topics_.size()); // most were there before
    state.error = error_;
    return state;
}

Result<void> McapRecorder::repair(const RecordingPlan &plan, QJsonObject &sidecar) {
    const QDir folder(plan.folder);
    QJsonArray files;
    double bytes = 0, messages = 0, end = sidecar["start"].toDouble();
    QSet<QString> topics;
    for (const QFileInfo &entry :
         folder.entryInfoList({plan.prefix + "-*.mcap"}, QDir::Files | QDir::NoSymLinks, QDir::Name)) {
        const auto repaired = mcap::repair(entry.absoluteFilePath().toStdString());
        if (!repaired)
            return diskError(QString::fromStdString(repaired.error()), entry.absoluteFilePath());
        double here = 0;
        for (const auto &[channel, count] : repaired->contents.counts)
            here += double(count);
        for (const auto &[id, channel] : repaired->contents.channels)
            topics.insert(QString::fromStdString(channel.topic));
        const double size = double(repaired->bytes);
        files.append(QJsonObject{{"name", entry.fileName()}, {"bytes", size}, {"messages", here}});
        bytes += size;
        messages += here;
        end = std::max(end, double(repaired->contents.end_ns) * 1e-9);
    }
    sidecar.insert("files", files);
    sidecar.insert("bytes", bytes);
    sidecar.insert("counts", QJsonObject{{"messages", messages}, {"topics", topics.size()}});
    sidecar.insert("end", end);
    return {};
}

} // namespace hermes::recorder
