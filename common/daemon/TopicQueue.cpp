#include "common/daemon/TopicQueue.h"

#include "common/Log.h"
#include "common/Time.h"
#include "protocol/jsonrpc/JsonRpc.h"

#include <algorithm>
#include <cmath>

namespace hermes {
namespace {

// So much may lie with the system before messages wait here, where newer ones can replace them.
constexpr qint64 handOverBytes = 32 << 10;

} // namespace

const EncodedFrame &TopicMessage::frame(Codec &codec) const {
    EncodedFrame &made = (*frames)[typeid(codec)];
    if (made.bytes.isEmpty() && !made.error)
        made = codec.encodeTopic(topic, seq, stamp, data);
    return made;
}

TopicQueue::TopicQueue(Channel &target, qint64 limit, QObject *parent)
    : QObject(parent)
    , channel(target)
    , byteLimit(limit) {
    rateTimer.setSingleShot(true);
    rateTimer.setTimerType(Qt::PreciseTimer);
    connect(&rateTimer, &QTimer::timeout, this, &TopicQueue::releaseHeld);
    connect(&channel.interface(), &Interface::drained, this, &TopicQueue::flush);
}

void TopicQueue::add(quint64 id, const QString &topic, const SubscribeOptions &options) {
    Subscription subscription;
    subscription.id = id;
    subscription.topic = topic;
    subscription.options = options;
    subscriptions.push_back(std::move(subscription));
}

std::optional<QString> TopicQueue::remove(quint64 id) {
    const auto found = std::find_if(subscriptions.begin(), subscriptions.end(),
                                    [id](const Subscription &one) { return one.id == id; });
    if (found == subscriptions.end())
        return std::nullopt;
    const QString topic = found->topic;
    subscriptions.erase(found);
    const auto gone = std::remove_if(frames.begin(), frames.end(), [this, id](const Frame &frame) {
        frameBytes -= frame.subscription == id ? frame.bytes.size() : 0;
        return frame.subscription == id;
    });
    frames.erase(gone, frames.end());
    return topic;
}

bool TopicQueue::wants(const QString &topic) const {
    return std::any_of(subscriptions.begin(), subscriptions.end(),
                       [&topic](const Subscription &one) { return one.topic == topic; });
}

bool TopicQueue::hasRoom(const QString &topic) const {
    return frames.empty() ||
           std::none_of(subscriptions.begin(), subscriptions.end(), [&topic](const Subscription &one) {
               return one.topic == topic && one.options.queue > 1;
           });
}

void TopicQueue::offer(const TopicMessage &message, quint64 onlyTo) {
    for (Subscription &subscription : subscriptions) {
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
        if (!rateTimer.isActive() || rateTimer.remainingTime() > wait_ms)
            rateTimer.start(wait_ms);
        return;
    }
    // A timer that is a little late does not lower the rate; after a pause the phase begins anew.
    const double period = 1 / subscription.options.maximumRate_hz;
    subscription.nextDue = std::max(subscription.nextDue + period, now + 0.9 * period);
    subscription.held.reset();
    enqueue(subscription, message);
}

void TopicQueue::releaseHeld() {
    const double now = monotonicNow();
    double next = 0;
    for (Subscription &subscription : subscriptions) {
        if (!subscription.held)
            continue;
        if (subscription.nextDue <= now)
            accept(subscription, *std::exchange(subscription.held, std::nullopt));
        else
            next = next == 0 ? subscription.nextDue : std::min(next, subscription.nextDue);
    }
    if (next > 0)
        rateTimer.start(int(std::ceil((next - now) * 1000)));
    flush();
}

void TopicQueue::enqueue(Subscription &subscription, const TopicMessage &message) {
    while (subscription.waiting >= subscription.options.queue)
        dropOldest(&subscription);
    const EncodedFrame &frame = message.frame(channel.codec());
    if (frame.error) {
        if (subscription.dropped++ == 0)
            logError(message.topic, frame.error->message);
        ++droppedInAll;
        return;
    }
    frames.push_back({subscription.id,
                      channel.codec().forSubscription(frame.bytes, subscription.id, subscription.dropped)});
    frameBytes += frames.back().bytes.size();
    ++subscription.waiting;
    while (frameBytes > byteLimit && frames.size() > 1)
        dropOldest(nullptr);
}

void TopicQueue::dropOldest(Subscription *of) {
    const auto oldest = std::find_if(frames.begin(), frames.end(), [of](const Frame &frame) {
        return !of || frame.subscription == of->id;
    });
    if (oldest == frames.end())
        return;
    if (Subscription *owner = find(oldest->subscription)) {
        --owner->waiting;
        ++owner->dropped;
    }
    ++droppedInAll;
    frameBytes -= oldest->bytes.size();
    frames.erase(oldest);
}

void TopicQueue::stream(const QString &topic, quint64 onlyTo, const Parts &parts) {
    for (Subscription &subscription : subscriptions)
        if (subscription.topic == topic && (onlyTo == 0 || subscription.id == onlyTo)) {
            subscription.parts = parts;
            subscription.held.reset(); // older than the series
        }
    flush();
}

void TopicQueue::flush() {
    do
        writeFrames();
    while (frames.empty() && hasSpace() && enqueueNextPart());
}

bool TopicQueue::hasSpace() const {
    return channel.isOpen() && channel.interface().bytesToWrite() < handOverBytes;
}

bool TopicQueue::enqueueNextPart() {
    for (Subscription &subscription : subscriptions) {
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
    while (!frames.empty() && hasSpace()) {
        const Frame frame = std::move(frames.front());
        frames.pop_front();
        frameBytes -= frame.bytes.size();
        Subscription *owner = find(frame.subscription);
        if (owner)
            --owner->waiting;
        if (!channel.interface().write(frame.bytes)) {
            ++droppedInAll;
            if (owner)
                ++owner->dropped;
        }
    }
}

TopicQueue::Subscription *TopicQueue::find(quint64 id) {
    const auto found = std::find_if(subscriptions.begin(), subscriptions.end(),
                                    [id](const Subscription &one) { return one.id == id; });
    return found == subscriptions.end() ? nullptr : &*found;
}

} // namespace hermes
