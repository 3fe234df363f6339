#include "common/daemon/Health.h"

#include "common/Time.h"

#include <algorithm>

namespace hermes {

QString toString(HealthLevel level) {
    static const char *const names[] = {"ok", "warn", "error", "stale"};
    return QLatin1String(names[int(level)]);
}

HealthLevel Health::Item::levelNow() const {
    return period > 0 && monotonicNow() - set > period ? HealthLevel::Stale : level;
}

void Health::set(const QString &name, HealthLevel level, const QString &message, const QJsonObject &values) {
    const bool isNew = !items_.contains(name);
    Item &item = items_[name];
    const bool differs = isNew || item.levelNow() != level;
    item.level = level;
    item.message = message;
    item.values = values;
    item.set = monotonicNow();
    if (differs)
        Q_EMIT changed();
}

void Health::provide(const QString &name, std::function<void()> update) {
    items_[name].update = std::move(update);
}

void Health::remove(const QString &name) {
    if (items_.remove(name) > 0)
        Q_EMIT changed();
}

void Health::expectEvery(const QString &name, std::chrono::milliseconds period) {
    Item &item = items_[name];
    item.period = std::chrono::duration<double>(period).count();
    if (item.set == 0)
        item.set = monotonicNow();
}

std::vector<HealthItem> Health::list() {
    for (const QString &name : items_.keys()) {
        if (const auto update = items_.value(name).update)
            update();
    }
    std::vector<HealthItem> list;
    for (auto item = items_.cbegin(); item != items_.cend(); ++item)
        list.push_back({item.key(), toString(item->levelNow()), item->message, item->values,
                        monotonicNow() - item->set});
    return list;
}

HealthLevel Health::worst() const {
    HealthLevel level = HealthLevel::Ok;
    for (const Item &item : items_)
        level = std::max(level, item.levelNow());
    return level;
}

} // namespace hermes
