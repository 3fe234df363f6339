#include "common/schema/Angles.h"

#include "common/AngleText.h"
#include "common/schema/SchemaKeys.h"

#include <QJsonArray>
#include <algorithm>
#include <optional>

namespace hermes {
namespace {

constexpr int maxTexts = 5;

bool isAngle(const QJsonObject &schema) {
    return schema.value(QStringLiteral("unit")) == QStringLiteral("rad");
}

/// Of a text as "90deg".
std::optional<double> angleIn(const QJsonValue &value) {
    if (!value.toString().endsWith(QStringLiteral("deg")))
        return std::nullopt;
    return parseAngle(value.toString().toStdString(), [](std::string_view text) {
        bool isNumber = false;
        const double number = QByteArray(text.data(), int(text.size())).toDouble(&isNumber);
        return isNumber && std::isfinite(number) ? std::optional(number) : std::nullopt;
    });
}

/// Of a value, or of one of those in it.
template <typename Holds>
bool anyHolds(const QJsonValue &value, const Holds &holds) {
    const auto below = [&holds](const QJsonValue &inner) { return anyHolds(inner, holds); };
    const QJsonObject object = value.toObject();
    const QJsonArray array = value.toArray();
    return holds(value) || std::any_of(object.begin(), object.end(), below) ||
           std::any_of(array.begin(), array.end(), below);
}

/// Lists may be long, and most hold no angle.
bool mayHoldAngles(const QJsonObject &items) {
    return isAngle(items) || items.contains(propertiesKey) || items.contains(itemsKey);
}

} // namespace

QStringList beyondTurn(const QJsonObject &schema, const QJsonValue &value, const QString &path) {
    if (value.isDouble())
        return isAngle(schema) && isBeyondTurn(value.toDouble())
                   ? QStringList(path + QStringLiteral(": ") +
                                 QString::fromStdString(beyondTurnText(value.toDouble())))
                   : QStringList();
    QStringList texts;
    const auto below = [&](const QJsonObject &inner, const QJsonValue &member, const QString &key) {
        if (texts.size() < maxTexts)
            texts += beyondTurn(inner, member, path.isEmpty() ? key : path + QLatin1Char('.') + key);
    };
    const QJsonObject object = value.toObject(), properties = schema.value(propertiesKey).toObject();
    for (auto member = object.begin(); member != object.end(); ++member)
        below(properties.value(member.key()).toObject(), member.value(), member.key());
    const QJsonObject items = schema.value(itemsKey).toObject();
    const QJsonArray array = mayHoldAngles(items) ? value.toArray() : QJsonArray();
    for (int i = 0; i < array.size(); ++i)
        below(items, array.at(i), QString::number(i));
    return texts.mid(0, maxTexts);
}

QJsonValue withAnglesRead(const QJsonObject &schema, const QJsonValue &value) {
    if (value.isString()) {
        const auto angle = isAngle(schema) ? angleIn(value) : std::nullopt;
        return angle ? QJsonValue(*angle) : value;
    }
    if (value.isArray()) {
        QJsonArray array = value.toArray();
        for (QJsonValueRef element : array)
            element = withAnglesRead(schema.value(itemsKey).toObject(), element);
        return array;
    }
    if (!value.isObject())
        return value;
    QJsonObject object = value.toObject();
    const QJsonObject properties = schema.value(propertiesKey).toObject();
    for (auto member = object.begin(); member != object.end(); ++member)
        member.value() = withAnglesRead(properties.value(member.key()).toObject(), member.value());
    return object;
}

bool holdsAngleText(const QJsonValue &value) {
    return anyHolds(value, [](const QJsonValue &one) { return angleIn(one).has_value(); });
}

bool holdsBeyondTurn(const QJsonValue &value) {
    return anyHolds(value, [](const QJsonValue &one) { return isBeyondTurn(one.toDouble()); });
}

} // namespace hermes
