#include "daemons/recorder/TopicRing.h"

#include "daemons/recorder/HaltCause.h"

namespace hermes::recorder {

void TopicRing::open(double seconds, std::size_t maxBytes) {
    seconds_ = seconds;
    maxBytes_ = maxBytes;
    bytes_ = 0;
    messages_.clear();
    before_.clear();
    wrong_.clear();
}

void TopicRing::add(const KeptMessage &message) {
    bytes_ += std::size_t(message.json.size());
    messages_.push_back(message);
    while (bytes_ > maxBytes_ || message.came.mono() - messages_.front().came.mono() > seconds_) {
        bytes_ -= std::size_t(messages_.front().json.size());
        before_[messages_.front().topic] = std::move(messages_.front());
        messages_.pop_front();
        if (messages_.empty())
            break;
    }
}

std::optional<Moment> TopicRing::begin() const {
    return messages_.empty() ? std::nullopt : std::optional(messages_.front().came);
}

// What came before begins with them: it tells how things were.
std::vector<KeptMessage> TopicRing::messages() const {
    std::vector<KeptMessage> all;
    for (const auto &[topic, message] : before_)
        all.push_back({topic, message.sequence, message.stamp, begin().value_or(message.came), message.json});
    all.insert(all.end(), messages_.begin(), messages_.end());
    return all;
}

// The first that is told of an item is how things are, and no alarm.
QString TopicRing::alarm(const QString &topic, const WireView &data) {
    QString alarm;
    const auto note = [&](const QString &item, const QString &now) {
        const auto [known, isNew] = wrong_.try_emplace(topic + '/' + item, now);
        if (!isNew && known->second.isEmpty() && !now.isEmpty())
            alarm = now;
        known->second = now;
    };
    if (topic.endsWith("/control"))
        note("halted", haltCause(data["cause"].text()).isFault() ? data["halted"].text() : QString());
    const WireView health = topic.endsWith("/status") ? data["health"] : WireView();
    for (std::size_t i = 0; i < health.size(); ++i)
        note(health[i]["name"].text(), health[i]["level"].text() == "error"
                                           ? health[i]["name"].text() + ": " + health[i]["message"].text()
                                           : QString());
    return alarm;
}

} // namespace hermes::recorder
