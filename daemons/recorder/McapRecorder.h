#pragma once

#include "common/Time.h"
#include "common/files/AppendFile.h"
#include "common/recording/RecordingWriter.h"
#include "protocol/mcap/Writer.h"

#include <QHash>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

namespace hermes::recorder {

/// A topic of the robot, as the files tell it.
struct RecordedTopic {
    QString topic;                               ///< "motorcontrol/odometry"
    QByteArray schema;                           ///< the JSON Schema of its data
    std::map<std::string, std::string> metadata; ///< of the channel
};

/// A message that came, and when.
struct KeptMessage {
    int topic = 0; ///< number
    quint64 sequence = 0;
    double stamp = 0; ///< when its data were true, s since the epoch
    Moment came;
    QByteArray json;
};

/// Writes messages of topics to PREFIX-0001.mcap and on, in a thread of its own. Time goes on evenly within a
/// recording, whatever happens to the wall clock.
class McapRecorder : public RecordingWriter {
public:
    ~McapRecorder() override { end(); }

    /// Bytes that may wait for the disk; what comes beyond is lost, and counted. Before the first recording.
    void setQueueBytes(std::size_t bytes) { maxWaiting_ = bytes; }

    bool goesOn() const override { return true; }
    std::optional<Moment> beganEarlier() const override { return earlier_; }
    Result<void> begin(const RecordingPlan &plan) override;
    void end() override;
    RecordingState state() const override;
    Result<void> repair(const RecordingPlan &plan, QJsonObject &sidecar) override;

    /// The next recording began then; nothing: when it begins.
    void setBegin(const std::optional<Moment> &earlier) { earlier_ = earlier; }
    /// A topic of this recording; gives its number for write(). Any thread, as what follows.
    int addTopic(const RecordedTopic &topic);
    void write(const KeptMessage &message);
    /// Messages that were lost before they came here.
    void noteLost(int topic, quint64 messages);

private:
    struct File {
        QString name;
        quint64 bytes = 0, messages = 0;
    };

    void run();
    bool writeAll(const std::deque<KeptMessage> &messages);
    bool openFile();
    bool closeFile();
    void mendFile();
    bool isFull() const;
    std::uint16_t channelOf(int topic);
    bool fail();

    std::optional<Moment> earlier_;
    std::size_t maxWaiting_ = std::size_t(64) << 20;
    std::thread thread_;
    // Of that thread while it runs:
    AppendFile file_;
    std::unique_ptr<mcap::Writer> writer_;
    QHash<int, std::uint16_t> channels_; ///< of the file, by topic
    double opened_ = 0;                  ///< the file; of monotonicNow()

    mutable std::mutex mutex_; // guards what follows
    std::condition_variable wake_;
    RecordingPlan plan_;
    bool takes_ = false, stopping_ = false;
    std::deque<RecordedTopic> topics_;
    std::vector<quint64> lost_; ///< messages, by topic
    std::deque<KeptMessage> waiting_;
    std::size_t waitingBytes_ = 0;
    quint64 messages_ = 0;
    std::vector<File> files_;
    std::optional<Error> error_;
};

} // namespace hermes::recorder
