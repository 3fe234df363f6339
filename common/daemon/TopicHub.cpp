#include "common/daemon/TopicHub.h"

#include "common/Log.h"
#include "common/Time.h"

#include <QStringList>
#include <algorithm>
#include <utility>

namespace hermes {

bool TopicHub::hasSubscribers(const QString &topic) const {
    const auto entry = topics_.constFind(topic);
    return entry != topics_.constEnd() && !entry->queues.isEmpty() && !entry->replay;
}

bool TopicHub::hasRoom(const QString &topic) const {
    const auto entry = topics_.constFind(topic);
    return entry == topics_.constEnd() ||
           std::all_of(entry->queues.begin(), entry->queues.end(),
                       [&topic](TopicQueue *queue) { return queue->hasRoom(topic); });
}

void TopicHub::publish(const QString &topic, const std::function<Outgoing()> &make, double stamp) {
    const auto entry = topics_.find(topic);
    if (entry == topics_.end())
        return logError(QStringLiteral("topics"),
                        QString("published \"%1\", which is not declared").arg(topic));
    if (entry->replay)
        return;
    ++entry->seq;
    const auto queues = entry->queues;
    if (queues.isEmpty())
        return;
    const TopicMessage message{topic, entry->seq, stamp, make()};
    for (TopicQueue *queue : queues)
        queue->offer(message);
}

Result<TopicHub::Entry *> TopicHub::find(const QString &topic) {
    const auto entry = topics_.find(topic);
    if (entry != topics_.end())
        return &*entry;
    const QStringList known = topics_.keys();
    return Error(
        ErrorCode::NoSuchTopic,
        QString("no topic \"%1\"; there is %2").arg(topic.left(80), known.join(QStringLiteral(", "))));
}

Result<quint64> TopicHub::subscribe(const QString &topic, const SubscribeOptions &options,
                                    TopicQueue *queue) {
    const auto found = find(topic);
    if (!found)
        return found.error();
    Entry *const entry = *found;
    const quint64 id = ++lastId_;
    queue->add(id, topic, options);
    if (!entry->queues.contains(queue))
        entry->queues.append(queue);
    if (entry->topic.snapshot() ||
        entry->topic.snapshotParts()) { // queued: it follows the reply that tells the id
        QMetaObject::invokeMethod(
            queue, [this, topic, id, queue] { sendSnapshot(topic, id, queue); }, Qt::QueuedConnection);
    }
    return id;
}

void TopicHub::sendSnapshot(const QString &topic, quint64 id, TopicQueue *queue) const {
    const Entry &entry = *topics_.constFind(topic);
    if (entry.replay)
        return queue->offer(entry.replay->last, id);
    if (entry.topic.snapshotParts())
        return queue->stream(topic, id, partsOf(topic));
    if (!entry.topic.snapshot())
        return;
    const Outgoing state = entry.topic.snapshot()();
    if (!state.isNothing())
        queue->offer({topic, entry.seq, stampNow(), state}, id);
}

TopicQueue::Parts TopicHub::partsOf(const QString &topic) const {
    return [this, topic, cursor = qint64(0)]() mutable -> std::optional<TopicMessage> {
        if (cursor < 0)
            return std::nullopt;
        const Entry &entry = *topics_.constFind(topic);
        if (entry.replay)
            return std::nullopt;
        const Outgoing part = entry.topic.snapshotParts()(cursor);
        return TopicMessage{topic, entry.seq, stampNow(), part};
    };
}

void TopicHub::publishSnapshot(const QString &topic) {
    const auto entry = topics_.find(topic);
    if (entry->replay)
        return;
    ++entry->seq;
    const auto queues = entry->queues;
    for (TopicQueue *queue : queues)
        sendSnapshot(topic, 0, queue);
}

bool TopicHub::isAlwaysLive(const QString &topic) {
    static const QStringList names{QStringLiteral("log"),       QStringLiteral("status"),
                                   QStringLiteral("settings"),  QStringLiteral("commands"),
                                   QStringLiteral("processes"), QStringLiteral("session"),
                                   QStringLiteral("control")};
    return names.contains(topic);
}

/// An error: it is unknown, or another client replays it.
Result<TopicHub::Entry *> TopicHub::findFor(const QString &topic, const TopicQueue *client) {
    const auto entry = find(topic);
    if (entry && (*entry)->replay && (*entry)->replay->client != client)
        return Error(ErrorCode::NotReady,
                     QString("the topic \"%1\" is replayed by %2").arg(topic, (*entry)->replay->name));
    return entry;
}

Result<void> TopicHub::replay(const QString &topic, const Outgoing &data, double stamp, TopicQueue *client,
                              const QString &name) {
    if (isAlwaysLive(topic))
        return Error(ErrorCode::InvalidParams,
                     QString("the topic \"%1\" tells of now and is never replayed").arg(topic));
    const auto entry = findFor(topic, client);
    if (!entry)
        return entry.error();
    const TopicMessage message{topic, ++(*entry)->seq, stamp, data, true};
    const bool isFirst = !(*entry)->replay;
    (*entry)->replay = {client, name, message};
    const auto queues = (*entry)->queues;
    for (TopicQueue *queue : queues)
        queue->offer(message);
    if (isFirst)
        Q_EMIT replaysChanged();
    return {};
}

Result<void> TopicHub::endReplay(const QString &topic, TopicQueue *client) {
    const auto entry = findFor(topic, client);
    if (!entry)
        return entry.error();
    if (std::exchange((*entry)->replay, std::nullopt)) {
        publishSnapshot(topic);
        Q_EMIT replaysChanged();
    }
    return {};
}

QString TopicHub::replays() const {
    QStringList texts;
    for (const Entry &entry : topics_)
        if (entry.replay)
            texts << QString("%1 (by %2)").arg(entry.topic.name(), entry.replay->name);
    return texts.join(QStringLiteral(", "));
}

bool TopicHub::unsubscribe(quint64 id, TopicQueue *queue) {
    const auto topic = queue->remove(id);
    if (topic && !queue->wants(*topic))
        topics_.find(*topic)->queues.removeAll(queue);
    return topic.has_value();
}

void TopicHub::forget(TopicQueue *queue) {
    for (Entry &entry : topics_)
        entry.queues.removeAll(queue);
    for (Entry &entry : topics_) // which publishes to those that are left
        if (entry.replay && entry.replay->client == queue)
            endReplay(entry.topic.name(), queue);
}

Role TopicHub::roleFor(const QString &topic) const {
    const auto entry = topics_.constFind(topic);
    return entry == topics_.constEnd() ? Role::Observer : entry->topic.role();
}

std::vector<TopicDescription> TopicHub::description() const {
    std::vector<TopicDescription> list;
    for (const Entry &entry : topics_)
        list.push_back(entry.topic.description());
    return list;
}

} // namespace hermes
