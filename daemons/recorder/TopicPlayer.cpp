#include "daemons/recorder/TopicPlayer.h"

#include "common/daemon/TopicHub.h"
#include "common/recording/DiskError.h"

#include <algorithm>

namespace hermes::recorder {
namespace {

constexpr std::size_t mostWaiting = 256, mostBytes = 4 << 20;
constexpr std::size_t mostRecalledBytes = 64 << 20;
constexpr std::chrono::milliseconds roomPeriod{5};
constexpr std::uint64_t second_ns = 1000000000, slack_ns = 60 * second_ns;
constexpr std::uint64_t longestWindow_ns = std::uint64_t(1) << 61;
constexpr double latest_s = 4e9; // of a clock

/// Whether the data of a topic, as of a map, continue those before.
bool isChange(std::string_view data) {
    return data.find("\"cleared\":false") != std::string_view::npos;
}

QString metadataOf(const mcap::Channel &channel, const char *name) {
    const auto found = channel.metadata.find(name);
    return found == channel.metadata.end() ? QString() : QString::fromStdString(found->second);
}

} // namespace

TopicPlayer::TopicPlayer() {
    again_.setSingleShot(true);
    connect(&again_, &QTimer::timeout, this, &TopicPlayer::give);
}

Result<void> TopicPlayer::start(const StoredRecording &recording, const Playback::Options &options,
                                std::int64_t begin_ns, const QStringList &without, Take take, End end) {
    stop();
    const Result<QStringList> files = recording.files();
    if (!files)
        return files.error();
    files_ = *files;
    without_ = without;
    begin_ns_ = std::uint64_t(std::max<std::int64_t>(begin_ns, 0));
    longest_ns_ = std::uint64_t(2e9 * std::clamp(recording.length_s, 0.0, latest_s)) + slack_ns;
    take_ = std::move(take);
    end_ = std::move(end);
    problems_.clear();
    if (const Result<void> whole = recording.isWhole(); !whole)
        problems_ << whole.error().message;
    time_ns_ = 0;
    playback_.start(options, [this] { run(); });
    return {};
}

void TopicPlayer::stop() {
    playback_.stop();
    again_.stop();
    held_.reset();
    waiting_.clear();
    bytes_ = 0;
    next_.reset();
    reader_.reset();
}

void TopicPlayer::run() {
    file_ = -1;
    advance();
    for (;;) {
        const Playback::Turn turn = wait();
        if (turn == Playback::Turn::End)
            return;
        if (turn == Playback::Turn::Seek) {
            goTo(playback_.takeSeek());
        } else if (next_) {
            push(recorded(*next_));
            advance();
        } else {
            close();
            return end_(problems_.isEmpty() ? Result<void>()
                                            : diskError(problems_.join("; "), files_.value(0)));
        }
    }
}

bool TopicPlayer::isWanted(const mcap::Channel &channel) const {
    const QString daemon = metadataOf(channel, "daemon"), topic = metadataOf(channel, "topic");
    return channel.encoding == "json" && !daemon.isEmpty() && !topic.isEmpty() &&
           !without_.contains(daemon) && !TopicHub::isAlwaysLive(topic);
}

void TopicPlayer::tell(const std::string &problem) {
    const QString text = files_.value(file_) + ": " + QString::fromStdString(problem);
    if (!problem.empty() && !problems_.contains(text))
        problems_ << text;
}

void TopicPlayer::close() {
    next_.reset();
    if (reader_)
        tell(reader_->problem());
    reader_.reset();
}

bool TopicPlayer::open(int file) {
    close();
    file_ = file;
    auto opened = mcap::Reader::open(files_[file].toStdString());
    if (!opened)
        return tell(opened.error()), false;
    reader_.emplace(opened.take());
    reader_->select([this](const mcap::Channel &channel) { return isWanted(channel); });
    return true;
}

/// To the next message, of the next file where this one has no more.
void TopicPlayer::advance() {
    next_ = reader_ ? reader_->next() : std::nullopt;
    while (!next_ && file_ + 1 < files_.size() && !playback_.isInterrupted())
        next_ = open(file_ + 1) ? reader_->next() : std::nullopt;
    if (next_)
        time_ns_ = std::max(time_ns_, timeOf(*next_));
}

std::int64_t TopicPlayer::timeOf(const mcap::Message &message) {
    const std::uint64_t since = message.logTime_ns - std::min(message.logTime_ns, begin_ns_);
    return std::int64_t(std::min(since, longest_ns_));
}

RecordedMessage TopicPlayer::recorded(const mcap::Message &message) const {
    const mcap::Channel &channel = reader_->channels().at(message.channel);
    return {metadataOf(channel, "daemon"), metadataOf(channel, "topic"),
            double(message.publishTime_ns) * 1e-9, QByteArray(message.data.data(), int(message.data.size()))};
}

/// Until the next message is due and there is room for it; at the end, until all has been taken.
Playback::Turn TopicPlayer::wait() {
    for (;;) {
        const Playback::Turn turn = next_ ? playback_.waitFor(time_ns_) : playback_.waitToEnd();
        if (turn != Playback::Turn::Due || (next_ ? hasRoom() : isTaken()))
            return turn;
        if (!playback_.rest(roomPeriod))
            return Playback::Turn::End;
    }
}

void TopicPlayer::goTo(std::int64_t time_ns) {
    playback_.jump(time_ns);
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        ++seeks_;
        waiting_.clear();
        bytes_ = 0;
    }
    const std::uint64_t place = begin_ns_ + std::uint64_t(std::max<std::int64_t>(time_ns, 0));
    const auto begins = [&](int file) {
        return open(file) && reader_->start_ns() > 0 && reader_->start_ns() <= place;
    };
    int file = int(files_.size()) - 1;
    while (file > 0 && !begins(file))
        --file;
    for (const auto &[time, message] : recall(file, place)) {
        while (!hasRoom())
            if (playback_.isInterrupted() || !playback_.rest(roomPeriod))
                return;
        push(message);
    }
    time_ns_ = 0;
    if (file >= 0 && open(file))
        reader_->seek(place);
    advance();
}

/// What each topic told last before that time, in the order of the times. Windows that grow into the past are
/// read, and of them only what may have a topic that was not found as yet.
std::deque<TopicPlayer::Timed> TopicPlayer::recall(int file, std::uint64_t until_ns) {
    Recall recall;
    bool goesOn = true;
    for (; file >= 0 && goesOn; --file) {
        if (!open(file))
            continue;
        const std::uint64_t start = reader_->start_ns();
        std::uint64_t until = std::min(until_ns, reader_->end_ns() + 1), window = 2 * second_ns;
        while (until > start && goesOn) {
            const std::uint64_t from = until - std::min(window, until - start);
            goesOn = recallBetween(from, until, recall);
            until = from;
            window = std::min(4 * window, longestWindow_ns);
        }
    }
    std::deque<Timed> all;
    for (auto &topic : recall.found)
        std::move(topic.second.begin(), topic.second.end(), std::back_inserter(all));
    std::stable_sort(all.begin(), all.end(),
                     [](const Timed &a, const Timed &b) { return a.first < b.first; });
    return all;
}

/// False: somebody seeks or ends the replay, or that is too much to be kept.
bool TopicPlayer::recallBetween(std::uint64_t from_ns, std::uint64_t until_ns, Recall &recall) {
    std::map<std::string, std::deque<Timed>> found;
    reader_->select([&](const mcap::Channel &channel) {
        return isWanted(channel) && recall.whole.count(channel.topic) == 0;
    });
    reader_->seek(from_ns);
    while (const auto message = reader_->next()) {
        if (playback_.isInterrupted() || recall.bytes > mostRecalledBytes)
            return false;
        if (message->logTime_ns >= until_ns)
            break;
        std::deque<Timed> &told = found[reader_->channels().at(message->channel).topic];
        if (!isChange(message->data)) {
            for (const Timed &before : told)
                recall.bytes -= std::size_t(before.second.data.size());
            told.clear();
        }
        told.emplace_back(message->logTime_ns, recorded(*message));
        recall.bytes += message->data.size();
    }
    for (auto &[topic, told] : found) {
        std::deque<Timed> &all = recall.found[topic];
        all.insert(all.begin(), told.begin(), told.end());
        const QByteArray &first = told.front().second.data;
        if (!isChange({first.constData(), std::size_t(first.size())}))
            recall.whole.insert(topic);
    }
    return true;
}

bool TopicPlayer::hasRoom() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return waiting_.size() < mostWaiting && bytes_ < mostBytes;
}

bool TopicPlayer::isTaken() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return waiting_.empty() && !held_;
}

void TopicPlayer::push(const RecordedMessage &message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (waiting_.empty())
        QMetaObject::invokeMethod(
            this, [this] { give(); }, Qt::QueuedConnection);
    bytes_ += std::size_t(message.data.size());
    waiting_.push_back(message);
}

/// Whether there is one to be given: that for which there was no room, but none from before a seek, or the
/// next.
bool TopicPlayer::hold(bool isTaken) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (isTaken || heldSince_ != seeks_)
        held_.reset();
    if (!held_ && !waiting_.empty()) {
        held_ = std::move(waiting_.front());
        heldSince_ = seeks_;
        waiting_.pop_front();
        bytes_ -= std::size_t(held_->data.size());
    }
    return held_.has_value();
}

void TopicPlayer::give() {
    for (bool isTaken = false; hold(isTaken); isTaken = true)
        if (!take_(*held_))
            return again_.start(roomPeriod);
}

} // namespace hermes::recorder
