#pragma once

#include "common/channel/Channel.h"

#include <QObject>
#include <QTimer>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <typeindex>
#include <vector>

namespace hermes {

/// One message of a topic on its way.
struct TopicMessage {
    QString topic;
    quint64 seq = 0; ///< counts the publications of the topic from 1
    double stamp = 0;
    Outgoing data;
    bool replayed = false; ///< it was recorded
    /// Its frame in each framing, made once for all who get it.
    using Frames = std::map<std::type_index, EncodedFrame>;
    std::shared_ptr<Frames> frames = std::make_shared<Frames>();

    const EncodedFrame &frame(Codec &codec) const;
};

/// How a client wants a topic.
struct SubscribeOptions {
    double maximumRate_hz = 0; ///< 0: every message
    int queue = 1;             ///< messages that may wait for a slow reader; 1: only the newest
};

/// The topic messages of one client: thinned to the rate asked for, waiting in bounded queues until the
/// client reads. What does not fit is dropped, oldest first, and counted in `dropped` of the messages that
/// follow.
class TopicQueue : public QObject {
    Q_OBJECT
public:
    /// The next message of a series; nothing after the last.
    using Parts = std::function<std::optional<TopicMessage>()>;

    TopicQueue(Channel &channel, qint64 byteLimit, QObject *parent);

    void add(quint64 id, const QString &topic, const SubscribeOptions &options);
    /// The topic of the subscription removed, or nothing when it is not one of this client.
    std::optional<QString> remove(quint64 id);
    bool wants(const QString &topic) const;
    /// False while messages wait for a reader of this topic who asked for a queue longer than one.
    bool hasRoom(const QString &topic) const;
    /// That wait.
    qint64 bytes() const { return frameBytes_; }
    bool isEmpty() const { return subscriptions_.empty(); }
    std::size_t size() const { return subscriptions_.size(); } ///< subscriptions
    /// To every subscription of this topic; or to one of them.
    void offer(const TopicMessage &message, quint64 onlyTo = 0);
    /// A series to every subscription of this topic, or to one of them; in place of one that is on its way.
    /// Each part is asked for when the client has read those before: none is dropped.
    void stream(const QString &topic, quint64 onlyTo, const Parts &parts);
    quint64 dropped() const { return droppedInAll_; }

private:
    struct Subscription {
        quint64 id = 0;
        QString topic;
        SubscribeOptions options;
        double nextDue = 0;               // monotonic: not before, by the rate
        std::optional<TopicMessage> held; // the newest, waiting for its time
        int waiting = 0;                  // frames of it in the queue
        quint64 dropped = 0;
        Parts parts; // of a snapshot on its way
    };
    struct Frame {
        quint64 subscription;
        QByteArray bytes;
    };

    void accept(Subscription &subscription, const TopicMessage &message);
    void enqueue(Subscription &subscription, const TopicMessage &message);
    void dropOldest(Subscription *of);
    void releaseHeld();
    void flush();
    void writeFrames();
    bool enqueueNextPart();
    Subscription *find(quint64 id);

    Channel &channel_;
    const qint64 byteLimit_;
    std::vector<Subscription> subscriptions_;
    std::deque<Frame> frames_;
    qint64 frameBytes_ = 0;
    quint64 droppedInAll_ = 0;
    QTimer rateTimer_;
};

} // namespace hermes
