#pragma once

#include "common/Result.h"
#include "common/daemon/Topic.h"
#include "common/daemon/TopicQueue.h"

#include <QMap>
#include <QObject>
#include <QVector>

namespace hermes {

/// The topics of a daemon and who subscribes to them. Use from the main thread.
class TopicHub : public QObject {
    Q_OBJECT
public:
    explicit TopicHub(QObject *parent)
        : QObject(parent) {}

    void declare(const Topic &topic) { topics_.insert(topic.name(), {topic, 0, {}}); }

    /// Ask before building costly data.
    bool hasSubscribers(const QString &topic) const;
    /// False while a reader who wants every message is behind: for sources that can wait.
    bool hasRoom(const QString &topic) const;
    /// To all subscribers; the data are made only where there are any. stamp: when the data were true, in
    /// seconds since the epoch. An unknown topic is an error in the log.
    void publish(const QString &topic, const std::function<Outgoing()> &make, double stamp);
    /// Sends the snapshot of the topic to all subscribers once more, after a change of everything.
    void publishSnapshot(const QString &topic);

    /// Whether it tells of faults or of what runs now, and so is never replayed.
    static bool isAlwaysLive(const QString &topic);
    /// A recorded message goes to all subscribers, and nothing else of this topic until its client, who is
    /// called that, ends it or goes. NotReady: another client replays it.
    Result<void> replay(const QString &topic, const Outgoing &data, double stamp, TopicQueue *client,
                        const QString &name);
    /// The topic begins anew with its snapshot.
    Result<void> endReplay(const QString &topic, TopicQueue *client);
    /// Which topics are, for people; empty: none.
    QString replays() const;

    /// The id of the new subscription, or NoSuchTopic. A topic with a snapshot sends it next.
    Result<quint64> subscribe(const QString &topic, const SubscribeOptions &options, TopicQueue *queue);
    bool unsubscribe(quint64 id, TopicQueue *queue);
    /// The client has gone.
    void forget(TopicQueue *queue);

    /// Who may subscribe to the topic.
    Role roleFor(const QString &topic) const;
    std::vector<TopicDescription> description() const;

Q_SIGNALS:
    /// replays() gives another text.
    void replaysChanged();

private:
    struct Replay {
        TopicQueue *client;
        QString name;
        TopicMessage last;
    };
    struct Entry {
        Topic topic;
        quint64 seq;
        QVector<TopicQueue *> queues;
        std::optional<Replay> replay = {};
    };

    Result<Entry *> find(const QString &topic);
    Result<Entry *> findFor(const QString &topic, const TopicQueue *client);

    void sendSnapshot(const QString &topic, quint64 id, TopicQueue *queue) const;

    TopicQueue::Parts partsOf(const QString &topic) const;

    QMap<QString, Entry> topics_;
    quint64 lastId_ = 0;
};

} // namespace hermes
