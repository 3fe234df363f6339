#pragma once

#include "common/recording/Playback.h"
#include "common/recording/StoredRecording.h"
#include "protocol/mcap/Reader.h"

#include <QByteArray>
#include <QObject>
#include <QStringList>
#include <QTimer>

#include <deque>
#include <map>
#include <mutex>
#include <set>

namespace hermes::recorder {

/// A message of a topic as it was recorded.
struct RecordedMessage {
    QString daemon, topic;
    double stamp = 0; ///< seconds since the epoch
    QByteArray data;  ///< JSON
};

/// Plays the topics of a recording, in a thread of its own, at the pace at which they came or any other.
/// Loses nothing: waits while those before have not been taken. Topics that tell what is wrong now are never
/// played (TopicHub::isAlwaysLive).
class TopicPlayer : public QObject {
    Q_OBJECT
public:
    /// Called in the main thread. False: there is no room now, and the message is given again soon.
    using Take = std::function<bool(const RecordedMessage &message)>;
    /// Called in the playing thread, once all has been taken or could not be read.
    using End = std::function<void(const Result<void> &result)>;

    TopicPlayer();
    ~TopicPlayer() override { stop(); }

    /// Time 0 of the replay is begin_ns of the times at which messages were written, since the epoch. Without
    /// names daemons that are left out. After a seek the last message of each topic before that place is
    /// played at once, too; where messages tell of changes, all since the one that told the whole.
    Result<void> start(const StoredRecording &recording, const Playback::Options &options,
                       std::int64_t begin_ns, const QStringList &without, Take take, End end);
    void stop();
    Playback &playback() { return playback_; }

private:
    using Timed = std::pair<std::uint64_t, RecordedMessage>;
    struct Recall {
        std::map<std::string, std::deque<Timed>> found; ///< by topic, the oldest first
        std::set<std::string> whole;                    ///< topics of which more is not needed
        std::size_t bytes = 0;
    };

    // Of the playing thread.
    void run();
    bool open(int file); ///< false: it cannot be read
    void close();
    void tell(const std::string &problem);
    bool isWanted(const mcap::Channel &channel) const;
    void advance();
    std::int64_t timeOf(const mcap::Message &message);
    RecordedMessage recorded(const mcap::Message &message) const;
    Playback::Turn wait();
    void goTo(std::int64_t time_ns);
    std::deque<Timed> recall(int file, std::uint64_t until_ns);
    bool recallBetween(std::uint64_t from_ns, std::uint64_t until_ns, Recall &recall);
    void push(const RecordedMessage &message);
    bool hasRoom();
    bool isTaken();

    // Of the main thread.
    bool hold(bool isTaken);
    void give();

    QStringList files_, without_;
    std::uint64_t begin_ns_ = 0;
    std::uint64_t longest_ns_ = 0; ///< whatever the files say
    End end_;
    std::optional<mcap::Reader> reader_;
    int file_ = 0; ///< that it reads
    std::optional<mcap::Message> next_;
    std::int64_t time_ns_ = 0; ///< of the replay, of the last one
    QStringList problems_;

    Take take_;
    QTimer again_;

    std::mutex mutex_; // guards what follows
    std::deque<RecordedMessage> waiting_;
    std::size_t bytes_ = 0;
    std::optional<RecordedMessage> held_; ///< taken from those, and not yet given
    quint64 seeks_ = 0, heldSince_ = 0;

    Playback playback_;
};

} // namespace hermes::recorder
