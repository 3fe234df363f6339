#include "gui/desktop/model/TopicSampler.h"

#include "common/Time.h"

#include <cmath>

namespace hermes::desktop {

TopicSampler::TopicSampler(Fleet &fleet, QObject *parent)
    : QObject(parent)
    , fleet_(fleet) {
    connect(&fleet, &Fleet::changed, this, &TopicSampler::followAll);
}

TopicSampler::~TopicSampler() {
    for (const auto &[topic, source] : sources_)
        if (source.daemon)
            source.daemon->unsubscribe(source.handle);
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
    const auto source = sources_.find(topic);
    if (source == sources_.end())
        return;
    if (source->second.daemon)
        source->second.daemon->unsubscribe(source->second.handle);
    sources_.erase(source);
}

// The subscription to a daemon that is away for a moment renews itself.
void TopicSampler::followAll() {
    for (auto &[topic, source] : sources_) {
        for (const auto &robot : fleet_.robots())
            for (DaemonLink *daemon : source.daemon ? std::vector<DaemonLink *>() : robot->daemons())
                if (daemon->address() == topic.first && daemon->hasTopic(topic.second)) {
                    source.daemon = daemon;
                    source.handle = daemon->subscribe(
                        topic.second, {{"max_rate_hz", maxRate_hz}},
                        [this, id = topic](const TopicUpdate &update) { take(id, update); });
                }
    }
}

const TopicSampler::Source *TopicSampler::source(const FieldId &field) const {
    const auto found = sources_.find({field.address, field.topic});
    return found == sources_.end() ? nullptr : &found->second;
}

const Samples &TopicSampler::samples(const FieldId &field) const {
    static const Samples none;
    const auto found = fields_.find(field);
    return found == fields_.end() ? none : found->second;
}

const Freshness &TopicSampler::freshness(const FieldId &field) const {
    static const Freshness none;
    const Source *const found = source(field);
    return found ? found->freshness : none;
}

QString TopicSampler::clock(const FieldId &field) const {
    const Source *const found = source(field);
    return found ? found->clock : QString();
}

bool TopicSampler::isRecorded(const FieldId &field) const {
    const Source *const found = source(field);
    return found && found->isRecorded;
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
