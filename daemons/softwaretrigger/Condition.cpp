#include "daemons/softwaretrigger/Condition.h"

#include <QJsonArray>
#include <QJsonObject>
#include <QStringList>
#include <utility>

namespace hermes::softwaretrigger {

QJsonValue lookUp(QJsonValue data, const QString &path) {
    if (path.isEmpty())
        return data;
    for (const QString &key : path.split('.')) {
        if (!data.isArray()) {
            data = data.toObject().value(key);
            continue;
        }
        bool isNumber = false;
        const int index = key.toInt(&isNumber);
        const QJsonArray array = data.toArray();
        data = isNumber && index >= 0 && index < array.size() ? array.at(index)
                                                              : QJsonValue(QJsonValue::Undefined);
    }
    return data;
}

std::optional<bool> Condition::holds(const QJsonValue &value) const {
    if (value.isUndefined())
        return std::nullopt;
    if (op_ == "==")
        return value == limit_;
    if (op_ == "!=")
        return value != limit_;
    if (!value.isDouble())
        return std::nullopt;
    const double number = value.toDouble(), limit = limit_.toDouble();
    if (op_ == "<")
        return number < limit;
    if (op_ == "<=")
        return number <= limit;
    return op_ == ">" ? number > limit : number >= limit;
}

std::optional<bool> Condition::becomesTrue(const QJsonValue &data) {
    const auto now = holds(lookUp(data, path_));
    if (!now)
        return std::nullopt;
    return !std::exchange(held_, *now) && *now;
}

} // namespace hermes::softwaretrigger
