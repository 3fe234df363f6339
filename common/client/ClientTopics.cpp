// What a client has subscribed to, and who gets the messages.
#include "common/client/Client.h"
#include "protocol/wire/JsonText.h"

#include <algorithm>
#include <cmath>

namespace hermes {
namespace {

constexpr std::size_t maxEarly = 16; // messages that wait for the reply to their subscription

constexpr double latestStamp = 1e10; // seconds: beyond it stamps lose their digits

} // namespace

qint64 Client::toCount(const QJsonValue &value) {
    const double number = value.toDouble(-1);
    return number >= 0 && number <= 9007199254740992.0 && number == std::floor(number) ? qint64(number) : -1;
}

int Client::subscribe(const QString &topic, const QJsonObject &options, const TopicCallback &callback) {
    const int handle = ++lastHandle_;
    subscriptions_[handle] = {topic, options, callback, 0};
    if (isConnected())
        sendSubscription(handle);
    return handle;
}

void Client::unsubscribe(int handle) {
    const auto found = subscriptions_.find(handle);
    if (found == subscriptions_.end())
        return;
    if (found->second.id != 0 && isConnected()) {
        call(QStringLiteral("topics.unsubscribe"),
             QJsonObject{{QStringLiteral("subscription"), found->second.id}},
             [](const Result<QJsonValue> &) {});
    }
    subscriptions_.erase(found);
}

void Client::sendSubscription(int handle) {
    const Subscription &subscription = subscriptions_.at(handle);
    if (channel_->isLossy() && !lookTimer_.isActive())
        lookWhoIsThere();
    QJsonObject params = subscription.options;
    params.insert(QStringLiteral("topic"), subscription.topic);
    call(QStringLiteral("topics.subscribe"), params, [this, handle](const Result<QJsonValue> &result) {
        const qint64 id = result ? toCount((*result)[QStringLiteral("subscription")]) : 0;
        const auto found = subscriptions_.find(handle);
        if (found == subscriptions_.end()) {
            if (result) // ended here before the daemon answered
                notify(QStringLiteral("topics.unsubscribe"),
                       QJsonObject{{QStringLiteral("subscription"), id}});
            return;
        }
        if (!result) {
            if (!result.error().is(ErrorCode::Disconnected)) // else it is made again after the reconnect
                Q_EMIT subscriptionFailed(handle, result.error());
            return;
        }
        if (id <= 0)
            Q_EMIT subscriptionFailed(handle,
                                      Error(ErrorCode::InvalidParams,
                                            QStringLiteral("the reply to topics.subscribe: found no number "
                                                           "as subscription, expected one from 1")));
        found->second.id = qMax<qint64>(0, id);
        deliverEarly(found->second.id);
    });
}

void Client::lookWhoIsThere() {
    if (subscriptions_.empty())
        return lookTimer_.stop();
    lookTimer_.start();
    const auto look = [this](const Result<QJsonValue> &info) {
        const double started = info ? (*info)[QStringLiteral("started")].toDouble() : 0;
        if (started == 0)
            return;
        const double before = std::exchange(daemonStarted_, started);
        if (before == 0 || before == started)
            return;
        for (auto &subscription : subscriptions_) {
            subscription.second.id = 0;
            sendSubscription(subscription.first);
        }
    };
    call(QStringLiteral("daemon.info"), QJsonObject(), look);
}

void Client::onNotification(const RpcRequest &notification, const WireValue &data) {
    const QJsonObject params = notification.params.toObject();
    const qint64 id = toCount(params.value(QStringLiteral("subscription")));
    const bool isTopic = notification.method == QStringLiteral("topic") && id > 0; // 0: not subscribed as yet
    const QString topicName = params.value(QStringLiteral("topic")).toString();
    if (const auto handle = isTopic ? handleOf(id, topicName) : std::nullopt)
        return deliver(*handle, params, data);
    if (isTopic && channel_->isLossy() && subscribes() && early_.size() < maxEarly) {
        early_.push_back({id, params, data});
        return;
    }
    ++refused_.unasked;
    // A line has no end: what an earlier program subscribed to goes on until somebody says no.
    if (isTopic && channel_->isLossy())
        notify(QStringLiteral("topics.unsubscribe"), QJsonObject{{QStringLiteral("subscription"), id}});
}

bool Client::subscribes() const {
    return std::any_of(subscriptions_.begin(), subscriptions_.end(),
                       [](const auto &one) { return one.second.id == 0; });
}

// A daemon that was started anew behind a line gives the numbers of earlier subscriptions to others.
std::optional<int> Client::handleOf(qint64 id, const QString &topicName) const {
    for (const auto &subscription : subscriptions_)
        if (subscription.second.id == id && subscription.second.topic == topicName)
            return subscription.first;
    return std::nullopt;
}

void Client::deliverEarly(qint64 id) {
    for (const Early &one : std::exchange(early_, {})) {
        if (one.id != id && subscribes())
            early_.push_back(one);
        else if (const auto handle = handleOf(one.id, one.params.value(QStringLiteral("topic")).toString()))
            deliver(*handle, one.params, one.data);
    }
}

void Client::deliver(int handle, const QJsonObject &params, const WireValue &data) {
    TopicUpdate update;
    update.handle = handle;
    update.topic = params.value(QStringLiteral("topic")).toString();
    update.seq = quint64(qMax<qint64>(0, toCount(params.value(QStringLiteral("seq")))));
    update.dropped = quint64(qMax<qint64>(0, toCount(params.value(QStringLiteral("dropped")))));
    update.stamp = params.value(QStringLiteral("stamp")).toDouble(latestStamp + 1);
    if (!(std::abs(update.stamp) <= latestStamp)) // NaN, too
        return refuse(
            {ErrorCode::InvalidParams,
             QString("topic %1: stamp: found %2, expected seconds since the Unix epoch")
                 .arg(update.topic, QString::fromUtf8(compactJson(params.value(QStringLiteral("stamp")))))});
    update.replayed = params.value(QStringLiteral("replayed")).toBool();
    // Of a message in a batch they were read with the rest.
    update.data =
        data.kind() == WireView::Kind::Undefined ? WireValue(params.value(QStringLiteral("data"))) : data;
    const auto found = subscriptions_.find(handle);
    if (found != subscriptions_.end() && found->second.callback) {
        const TopicCallback callback = found->second.callback;
        callback(update);
    }
    Q_EMIT topic(update);
}

} // namespace hermes
