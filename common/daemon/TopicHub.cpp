#include "common/daemon/TopicHub.h"

#include "common/Log.h"
#include "common/Time.h"

#include <QStringList>
#include <algorithm>

namespace hermes {

bool TopicHub::hasSubscribers(const QString &topic) const {
    const auto entry = topics_.constFind(topic);
    return entry != topics_.constEnd() && !entry->queues.isEmpty();
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
                        QStringLiteral("published \"%1\", which is not declared").arg(topic));
    ++entry->seq;
    const auto queues = entry->queues;
    if (queues.isEmpty())
        return;
    const TopicMessage message{topic, entry->seq, stamp, make()};
    for (TopicQueue *queue : queues)
        queue->offer(message);
}

Result<quint64> TopicHub::subscribe(const QString &topic, const SubscribeOptions &options,
                                    TopicQueue *queue) {
    const auto entry = topics_.find(topic);
    if (entry == topics_.end()) {
        const QStringList known = topics_.keys();
        return Error(ErrorCode::NoSuchTopic, QStringLiteral("no topic \"%1\"; there is %2")
                                                 .arg(topic.left(80), known.join(QStringLiteral(", "))));
    }
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
    if (entry.topic.snapshotParts())
        return queue->stream(topic, id, partsOf(topic));
    const Outgoing state = entry.topic.snapshot()();
    if (!state.isNothing())
        queue->offer({topic, entry.seq, stampNow(), state}, id);
}

TopicQueue::Parts TopicHub::partsOf(const QString &topic) const {
    return [this, topic, cursor = qint64(0)]() mutable -> std::optional<TopicMessage> {
        if (cursor < 0)
            return std::nullopt;
        const Entry &entry = *topics_.constFind(topic);
        const Outgoing part = entry.topic.snapshotParts()(cursor);
        return TopicMessage{topic, entry.seq, stampNow(), part};
    };
}

void TopicHub::publishSnapshot(const QString &topic) {
    const auto entry = topics_.find(topic);
    ++entry->seq;
    const auto queues = entry->queues;
    for (TopicQueue *queue : queues)
        queue->stream(topic, 0, partsOf(topic));
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
}

std::vector<TopicDescription> TopicHub::description() const {
    std::vector<TopicDescription> list;
    for (const Entry &entry : topics_)
        list.push_back(entry.topic.description());
    return list;
}

} // namespace hermes
