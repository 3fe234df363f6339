#include "gui/desktop/model/TopicSampler.h"

#include "common/Time.h"

#include <cmath>

namespace hermes::desktop {

TopicSampler::TopicSampler(Fleet &fleet, QObject *parent)
    : QObject(parent)
    , fleet_(fleet) {
    connect(&fleet, &Fleet::changed, this, &TopicSampler::followAll);
}

void TopicSampler::add(const FieldId &field) {
    fields_.emplace(field, Samples());
    sources_[{field.address, field.topic}];
    followAll();
}

void TopicSampler::remove(const FieldId &field) {
    fields_.erase(field);
    const TopicId topic(field.address, field.topic);
    for (const auto &[other, samples] : fields_)
        if (TopicId(other.address, other.topic) == topic)
            return;
    sources_.erase(topic);
}

// The subscription to a daemon that is away for a moment renews itself.
void TopicSampler::followAll() {
    for (auto &[topic, source] : sources_) {
        DaemonLink *const daemon = source.daemon ? nullptr : fleet_.daemonAt(topic.first);
        if (!daemon || !daemon->hasTopic(topic.second))
            continue;
        source.daemon = daemon;
        source.subscription =
            daemon->subscribe(topic.second, {{"max_rate_hz", maxRate_hz}},
                              [this, id = topic](const TopicUpdate &update) { take(id, update); });
    }
}

const TopicSampler::Source &TopicSampler::source(const FieldId &field) const {
    static const Source none;
    const auto found = sources_.find({field.address, field.topic});
    return found == sources_.end() ? none : found->second;
}

const Samples &TopicSampler::samples(const FieldId &field) const {
    static const Samples none;
    const auto found = fields_.find(field);
    return found == fields_.end() ? none : found->second;
}

double TopicSampler::now(const QString &clock) const {
    constexpr double silent_s = 2; // whose newest stamp may be of before a leap of the replay
    double last = 0, now = -largest;
    for (const auto &[topic, source] : sources_)
        if (source.clock == clock)
            last = std::max(last, source.arrived);
    for (const auto &[topic, source] : sources_) {
        if (source.clock != clock)
            continue;
        if (!source.isRecorded)
            now = std::max(now, source.newest + monotonicNow() - source.arrived);
        else if (source.arrived >= last - silent_s)
            now = std::max(now, source.newest);
    }
    return now;
}

void TopicSampler::take(const TopicId &topic, const TopicUpdate &update) {
    Source &source = sources_[topic];
    source.freshness.heard(source.daemon);
    source.newest = update.stamp;
    source.arrived = monotonicNow();
    source.isRecorded = !(std::abs(stampNow() - update.stamp) < recorded_s);
    source.clock = topic.first.section(':', 0, -2) + (source.isRecorded ? " recorded" : " now");
    for (auto &[field, samples] : fields_) {
        if (TopicId(field.address, field.topic) != topic)
            continue;
        const WireView value = messageValueAt(update.data, field.path);
        const double number =
            value.kind() == WireView::Kind::Boolean ? double(value.boolean()) : value.number();
        if (std::abs(number) <= largest)
            keep(samples, {update.stamp, number});
        else
            ++unusable_;
    }
}

void TopicSampler::keep(Samples &samples, const QPointF &sample) {
    if (!samples.empty() && sample.x() < samples.back().x()) {
        if (sample.x() >= samples.back().x() - late_s)
            return;
        samples.clear();
    }
    samples.push_back(sample);
    while (samples.front().x() < sample.x() - keep_s || samples.size() > maxSamples)
        samples.pop_front();
}

} // namespace hermes::desktop
