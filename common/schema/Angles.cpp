#include "common/schema/Angles.h"

#include "common/AngleText.h"
#include "common/schema/SchemaKeys.h"

#include <QJsonArray>
#include <algorithm>

namespace hermes {
namespace {

constexpr int mostTexts = 5;

bool isAngle(const QJsonObject &schema) {
    return schema.value(QStringLiteral("unit")) == QStringLiteral("rad");
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
        if (texts.size() < mostTexts)
            texts += beyondTurn(inner, member, path.isEmpty() ? key : path + QLatin1Char('.') + key);
    };
    const QJsonObject object = value.toObject(), properties = schema.value(propertiesKey).toObject();
    for (auto member = object.begin(); member != object.end(); ++member)
        below(properties.value(member.key()).toObject(), member.value(), member.key());
    const QJsonObject items = schema.value(itemsKey).toObject();
    const QJsonArray array = mayHoldAngles(items) ? value.toArray() : QJsonArray();
    for (int i = 0; i < array.size(); ++i)
        below(items, array.at(i), QString::number(i));
    return texts.mid(0, mostTexts);
}

bool holdsBeyondTurn(const QJsonValue &value) {
    const QJsonObject object = value.toObject();
    const QJsonArray array = value.toArray();
    return isBeyondTurn(value.toDouble()) || std::any_of(object.begin(), object.end(), holdsBeyondTurn) ||
           std::any_of(array.begin(), array.end(), holdsBeyondTurn);
}

} // namespace hermes
