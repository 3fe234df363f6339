#include "daemons/recorder/TopicReturn.h"

#include "protocol/jsonrpc/JsonCodec.h"

#include <QPointer>

namespace hermes::recorder {
namespace {

constexpr int mostUnanswered = 16;
constexpr std::chrono::seconds patience{2};
constexpr int largestMessage =
    JsonCodec::defaultFrameLimit - 1024; // that a daemon takes, with what goes around it

} // namespace

bool TopicReturn::take(const RecordedMessage &message) {
    if (std::exchange(isOver_, false)) {
        targets_.clear();
        ++replays_;
    }
    Target &target = targets_[message.daemon];
    Client *const client = find_(message.daemon);
    if (!client || !client->isConnected())
        target.miss("it does not run");
    else if (message.data.size() > largestMessage)
        target.miss(QString("a message of %1 has %2 bytes, more than a daemon takes")
                        .arg(message.topic)
                        .arg(message.data.size()));
    else if (target.isSilent && target.waiting > 0)
        target.miss("it does not answer");
    else if (target.waiting >= mostUnanswered)
        return false;
    else
        send(*client, message);
    return true;
}

void TopicReturn::send(Client &client, const RecordedMessage &message) {
    Target &target = targets_[message.daemon];
    WireError wrong;
    const auto data = WireValue::parse(message.data, &wrong);
    if (!data)
        return target.miss(message.topic + ": " + wrong.message);
    target.topics.insert(message.topic);
    ++target.waiting;
    const auto answered = [self = QPointer<TopicReturn>(this), replay = replays_,
                           daemon = message.daemon](const Result<QJsonValue> &result) {
        if (!self || self->replays_ != replay)
            return;
        Target &answering = self->targets_[daemon];
        --answering.waiting;
        answering.isSilent = !result && result.error().is(ErrorCode::TimedOut);
        if (!result)
            answering.miss(result.error().message);
    };
    client.call("topics.replay",
                QJsonObject{{"topic", message.topic}, {"stamp", message.stamp}, {"data", data->toJson()}},
                answered, patience);
}

void TopicReturn::end() {
    isOver_ = true;
    for (auto target = targets_.begin(); target != targets_.end(); ++target) {
        Client *const client = target->topics.isEmpty() ? nullptr : find_(target.key());
        for (const QString &topic : std::exchange(target->topics, {}))
            if (client)
                client->notify("topics.replay", QJsonObject{{"topic", topic}, {"live", true}});
    }
}

QStringList TopicReturn::problems() const {
    QStringList lines;
    for (auto target = targets_.begin(); target != targets_.end(); ++target)
        if (target->missed > 0)
            lines << QString("%1: %2 messages were not shown, the last: %3")
                         .arg(target.key())
                         .arg(target->missed)
                         .arg(target->why);
    return lines;
}

} // namespace hermes::recorder
