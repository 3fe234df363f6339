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
    const bool isNew = !items.contains(name);
    Item &item = items[name];
    const bool differs = isNew || item.levelNow() != level;
    item.level = level;
    item.message = message;
    item.values = values;
    item.set = monotonicNow();
    if (differs)
        Q_EMIT changed();
}

void Health::provide(const QString &name, std::function<void()> update) {
    items[name].update = std::move(update);
}

void Health::remove(const QString &name) {
    if (items.remove(name) > 0)
        Q_EMIT changed();
}

void Health::expectEvery(const QString &name, std::chrono::milliseconds period) {
    Item &item = items[name];
    item.period = std::chrono::duration<double>(period).count();
    if (item.set == 0)
        item.set = monotonicNow();
}

QJsonArray Health::toJson() {
    for (const QString &name : items.keys()) {
        if (const auto update = items.value(name).update)
            update();
    }
    QJsonArray array;
    for (auto item = items.cbegin(); item != items.cend(); ++item) {
        array.append(QJsonObject{{QStringLiteral("name"), item.key()},
                                 {QStringLiteral("level"), toString(item->levelNow())},
                                 {QStringLiteral("message"), item->message},
                                 {QStringLiteral("values"), item->values},
                                 {QStringLiteral("age_s"), monotonicNow() - item->set}});
    }
    return array;
}

HealthLevel Health::worst() const {
    HealthLevel level = HealthLevel::Ok;
    for (const Item &item : items)
        level = std::max(level, item.levelNow());
    return level;
}

} // namespace hermes
