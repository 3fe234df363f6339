#include "gui/desktop/model/TopicSampler.h"

#include <QJsonArray>
#include <cmath>

namespace hermes::desktop {
namespace {

/// Longer lists are no set of numbers to choose from: a scan has thousands.
constexpr int longestList = 16;

void collect(const QJsonValue &value, const QString &prefix, int most, QStringList &paths) {
    if (paths.size() >= most)
        return;
    const auto inner = [&](const QString &name) { return prefix.isEmpty() ? name : prefix + "." + name; };
    if (value.isDouble() || value.isBool()) {
        paths.append(prefix);
    } else if (value.isObject()) {
        const QJsonObject object = value.toObject();
        for (auto member = object.begin(); member != object.end(); ++member)
            collect(member.value(), inner(member.key()), most, paths);
    } else if (value.isArray() && value.toArray().size() <= longestList) {
        const QJsonArray array = value.toArray();
        for (int i = 0; i < array.size(); ++i)
            collect(array[i], inner(QString::number(i)), most, paths);
    }
}

} // namespace

QStringList numericPaths(const QJsonValue &message, int most) {
    QStringList paths;
    collect(message, {}, most, paths);
    return paths;
}

QJsonValue fieldAt(const QJsonValue &message, const QString &path) {
    QJsonValue value = message;
    if (path.isEmpty())
        return value;
    for (const QString &name : path.split('.'))
        value = value.isArray() ? value.toArray().at(name.toInt()) : value[name];
    return value;
}

TopicSampler::~TopicSampler() {
    for (const auto &[topic, source] : sources_)
        if (source.daemon)
            source.daemon->unsubscribe(source.handle);
}

void TopicSampler::add(DaemonLink *daemon, const FieldId &field) {
    if (!fields_.emplace(field, std::deque<QPointF>()).second)
        return;
    const TopicId topic(field.address, field.topic);
    Source &source = sources_[topic];
    if (source.daemon)
        return;
    source.daemon = daemon;
    source.handle = daemon->subscribe(field.topic, {{"max_rate_hz", maxRate_hz}},
                                      [this, topic](const TopicUpdate &update) { take(topic, update); });
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

const std::deque<QPointF> &TopicSampler::samples(const FieldId &field) const {
    static const std::deque<QPointF> none;
    const auto found = fields_.find(field);
    return found == fields_.end() ? none : found->second;
}

void TopicSampler::take(const TopicId &topic, const TopicUpdate &update) {
    for (auto &[field, samples] : fields_) {
        if (TopicId(field.address, field.topic) != topic)
            continue;
        const QJsonValue value = fieldAt(update.json(), field.path);
        const double number = value.isBool() ? double(value.toBool()) : value.toDouble(2 * largest);
        if (!(std::abs(number) <= largest && std::abs(update.stamp) <= largest)) {
            ++unusable_;
            continue;
        }
        if (!samples.empty() && update.stamp < samples.back().x())
            samples.clear(); // the daemon's clock was set back
        samples.push_back({update.stamp, number});
        while (samples.front().x() < update.stamp - keep_s || samples.size() > mostSamples)
            samples.pop_front();
    }
}

} // namespace hermes::desktop
