#include "common/schema/SchemaText.h"

#include "protocol/wire/JsonText.h"

#include <QJsonArray>
#include <QStringList>

namespace hermes {
namespace {

/// Of alternatives, so many are named.
constexpr int maxNamed = 100;

template <typename Text>
QStringList named(const QJsonArray &alternatives, const Text &textOf) {
    QStringList texts;
    for (int i = 0; i < alternatives.size() && i < maxNamed; ++i)
        texts.append(textOf(alternatives.at(i)));
    if (alternatives.size() > maxNamed)
        texts.append(QString("%1 more").arg(alternatives.size() - maxNamed));
    return texts;
}

QString typeName(const QJsonValue &type) {
    if (type.isArray())
        return named(type.toArray(), typeName).join(QStringLiteral(" or "));
    const QString name = type.toString();
    if (name.isEmpty())
        return QStringLiteral("a value");
    const QString article = name == QStringLiteral("null")              ? QString()
                            : QStringLiteral("aeiou").contains(name[0]) ? QStringLiteral("an ")
                                                                        : QStringLiteral("a ");
    return article + name;
}

QString limits(const QJsonObject &schema) {
    const QJsonValue least = schema.value(QStringLiteral("minimum"));
    const QJsonValue most = schema.value(QStringLiteral("maximum"));
    if (least.isDouble() && most.isDouble())
        return QString(" from %1 to %2").arg(shown(least), shown(most));
    if (least.isDouble())
        return QString(" of at least %1").arg(shown(least));
    return most.isDouble() ? QString(" of at most %1").arg(shown(most)) : QString();
}

QString sizes(const QJsonObject &schema, const char *least, const char *most, const QString &what) {
    const QJsonValue minimum = schema.value(QLatin1String(least));
    const QJsonValue maximum = schema.value(QLatin1String(most));
    if (minimum.isDouble() && minimum == maximum)
        return QString(" of %1 %2").arg(shown(minimum), what);
    QStringList parts;
    if (minimum.isDouble())
        parts.append(QString("at least %1").arg(shown(minimum)));
    if (maximum.isDouble())
        parts.append(QString("at most %1").arg(shown(maximum)));
    return parts.isEmpty() ? QString() : QString(" with %1 %2").arg(parts.join(QStringLiteral(", ")), what);
}

} // namespace

QString expectation(const QJsonObject &schema) {
    const QJsonArray choices = schema.value(QStringLiteral("enum")).toArray();
    if (!choices.isEmpty())
        return QStringLiteral("one of ") + named(choices, shown).join(QStringLiteral(", "));
    QString text = typeName(schema.value(QStringLiteral("type"))) + limits(schema);
    text += sizes(schema, "minItems", "maxItems", QStringLiteral("elements"));
    text += sizes(schema, "minLength", "maxLength", QStringLiteral("characters"));
    if (schema.contains(QStringLiteral("items")))
        text += QStringLiteral(", each ") + expectation(schema.value(QStringLiteral("items")).toObject());
    if (schema.contains(QStringLiteral("pattern")))
        text += QStringLiteral(" matching ") + schema.value(QStringLiteral("pattern")).toString();
    const QString unit = schema.value(QStringLiteral("unit")).toString();
    return unit.isEmpty() ? text : text + QStringLiteral(" in ") + unit;
}

QString shown(const QJsonValue &value) {
    constexpr int longest = 80;
    const QString text = QString::fromUtf8(compactJson(value));
    return text.size() <= longest ? text : text.left(longest) + QStringLiteral("...");
}

} // namespace hermes
