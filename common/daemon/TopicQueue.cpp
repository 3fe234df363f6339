#include "common/daemon/TopicQueue.h"

#include "common/Log.h"
#include "common/Time.h"
#include "protocol/jsonrpc/JsonRpc.h"

#include <algorithm>
#include <cmath>

namespace hermes {
const EncodedFrame &TopicMessage::frame(Codec &codec) const {
    EncodedFrame &made = (*frames)[typeid(codec)];
    if (made.bytes.isEmpty() && !made.error)
        made = codec.encodeTopic(topic, seq, stamp, data, replayed);
    return made;
}

TopicQueue::TopicQueue(Channel &target, qint64 limit, QObject *parent)
    : QObject(parent)
    , channel_(target)
    , byteLimit_(limit) {
    rateTimer_.setSingleShot(true);
    rateTimer_.setTimerType(Qt::PreciseTimer);
    connect(&rateTimer_, &QTimer::timeout, this, &TopicQueue::releaseHeld);
    connect(&channel_, &Channel::drained, this, &TopicQueue::flush);
}

void TopicQueue::add(quint64 id, const QString &topic, const SubscribeOptions &options) {
    Subscription subscription;
    subscription.id = id;
    subscription.topic = topic;
    subscription.options = options;
    subscriptions_.push_back(std::move(subscription));
}

std::optional<QString> TopicQueue::remove(quint64 id) {
    const auto found = std::find_if(subscriptions_.begin(), subscriptions_.end(),
                                    [id](const Subscription &one) { return one.id == id; });
    if (found == subscriptions_.end())
        return std::nullopt;
    const QString topic = found->topic;
    subscriptions_.erase(found);
    const auto gone = std::remove_if(frames_.begin(), frames_.end(), [this, id](const Frame &frame) {
        frameBytes_ -= frame.subscription == id ? frame.bytes.size() : 0;
        return frame.subscription == id;
    });
    frames_.erase(gone, frames_.end());
    return topic;
}

bool TopicQueue::wants(const QString &topic) const {
    return std::any_of(subscriptions_.begin(), subscriptions_.end(),
                       [&topic](const Subscription &one) { return one.topic == topic; });
}

bool TopicQueue::hasRoom(const QString &topic) const {
    return frames_.empty() ||
           std::none_of(subscriptions_.begin(), subscriptions_.end(), [&topic](const Subscription &one) {
               return one.topic == topic && one.options.queue > 1;
           });
}

void TopicQueue::offer(const TopicMessage &message, quint64 onlyTo) {
    for (Subscription &subscription : subscriptions_) {
        if (subscription.topic == message.topic && (onlyTo == 0 || subscription.id == onlyTo))
            accept(subscription, message);
    }
    flush();
}

void TopicQueue::accept(Subscription &subscription, const TopicMessage &message) {
    if (subscription.options.maximumRate_hz <= 0)
        return enqueue(subscription, message);
    const double now = monotonicNow();
    if (now < subscription.nextDue) {
        subscription.held = message;
        const int wait_ms = int(std::ceil((subscription.nextDue - now) * 1000));
        if (!rateTimer_.isActive() || rateTimer_.remainingTime() > wait_ms)
            rateTimer_.start(wait_ms);
        return;
    }
    // A timer that is a little late does not lower the rate; after a pause the phase begins anew.
    constexpr double longestPeriod_s = 24 * 3600; // that a timer can wait
    const double period = std::min(1 / subscription.options.maximumRate_hz, longestPeriod_s);
    subscription.nextDue = std::max(subscription.nextDue + period, now + 0.9 * period);
    subscription.held.reset();
    enqueue(subscription, message);
}

void TopicQueue::releaseHeld() {
    const double now = monotonicNow();
    double next = 0;
    for (Subscription &subscription : subscriptions_) {
        if (!subscription.held)
            continue;
        if (subscription.nextDue <= now)
            accept(subscription, *std::exchange(subscription.held, std::nullopt));
        else
            next = next == 0 ? subscription.nextDue : std::min(next, subscription.nextDue);
    }
    if (next > 0)
        rateTimer_.start(int(std::ceil((next - now) * 1000)));
    flush();
}

void TopicQueue::enqueue(Subscription &subscription, const TopicMessage &message) {
    while (subscription.waiting >= subscription.options.queue)
        dropOldest(&subscription);
    const EncodedFrame &frame = message.frame(channel_.codec());
    if (frame.error) {
        if (subscription.dropped++ == 0)
            logError(message.topic, frame.error->message);
        ++droppedInAll_;
        return;
    }
    frames_.push_back({subscription.id,
                       channel_.codec().forSubscription(frame.bytes, subscription.id, subscription.dropped)});
    frameBytes_ += frames_.back().bytes.size();
    ++subscription.waiting;
    while (frameBytes_ > byteLimit_ && frames_.size() > 1)
        dropOldest(nullptr);
}

void TopicQueue::dropOldest(Subscription *of) {
    const auto oldest = std::find_if(frames_.begin(), frames_.end(), [of](const Frame &frame) {
        return !of || frame.subscription == of->id;
    });
    if (oldest == frames_.end())
        return;
    if (Subscription *owner = find(oldest->subscription)) {
        --owner->waiting;
        ++owner->dropped;
    }
    ++droppedInAll_;
    frameBytes_ -= oldest->bytes.size();
    frames_.erase(oldest);
}

void TopicQueue::stream(const QString &topic, quint64 onlyTo, const Parts &parts) {
    for (Subscription &subscription : subscriptions_)
        if (subscription.topic == topic && (onlyTo == 0 || subscription.id == onlyTo)) {
            subscription.parts = parts;
            subscription.held.reset(); // older than the series
        }
    flush();
}

void TopicQueue::flush() {
    do
        writeFrames();
    while (frames_.empty() && channel_.hasSpaceForTopics() && enqueueNextPart());
}

bool TopicQueue::enqueueNextPart() {
    for (Subscription &subscription : subscriptions_) {
        if (!subscription.parts)
            continue;
        if (const auto part = subscription.parts()) {
            enqueue(subscription, *part);
            return true;
        }
        subscription.parts = nullptr;
    }
    return false;
}

void TopicQueue::writeFrames() {
    while (!frames_.empty() && channel_.hasSpaceForTopics()) {
        const Frame frame = std::move(frames_.front());
        frames_.pop_front();
        frameBytes_ -= frame.bytes.size();
        Subscription *owner = find(frame.subscription);
        if (owner)
            --owner->waiting;
        if (!channel_.write(frame.bytes, Channel::Rank::Topic)) {
            ++droppedInAll_;
            if (owner)
                ++owner->dropped;
        }
    }
}

TopicQueue::Subscription *TopicQueue::find(quint64 id) {
    const auto found = std::find_if(subscriptions_.begin(), subscriptions_.end(),
                                    [id](const Subscription &one) { return one.id == id; });
    return found == subscriptions_.end() ? nullptr : &*found;
}

} // namespace hermes
