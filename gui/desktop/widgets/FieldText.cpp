#include "gui/desktop/widgets/FieldText.h"

#include "common/schema/SchemaText.h"
#include "gui/desktop/widgets/ForeignText.h"
#include "gui/desktop/widgets/Quantities.h"

#include <QCoreApplication>
#include <QJsonArray>
#include <QJsonDocument>
#include <QRegularExpression>
#include <QSet>
#include <cmath>

namespace hermes::desktop {
namespace {

QString fieldTr(const char *text) {
    return QCoreApplication::translate("FieldText", text);
}

QString amountText(double value, const QString &unit) {
    const QString spoken = spokenAmount(value, unit);
    return spoken.isEmpty() ? numberText(value) : spoken;
}

} // namespace

QString titleOf(const QString &path, const QJsonObject &schema) {
    const QString title = schema["title"].toString();
    if (!title.isEmpty())
        return title;
    QStringList words = path.section('.', path.contains('.') ? 1 : 0).split(QRegularExpression("[._]"));
    static const QSet<QString> units{"s", "m", "v", "a", "c", "b", "mps", "rps", "hz", "deg", "rad", "bytes"};
    if (schema.contains("unit") && words.size() > 1 && units.contains(words.back()))
        words.removeLast();
    return words.join(' ');
}

QString shownUnit(const QJsonObject &schema) {
    return shortLine(schema["unit"].toString(), longestUnit)
        .replace("^2", u8"\u00b2")
        .replace("^3", u8"\u00b3");
}

QString limitsOf(const QJsonObject &schema) {
    const QJsonValue least = schema["minimum"], most = schema["maximum"];
    const QString unit = schema["unit"].toString();
    const QString lower = amountText(least.toDouble(), unit), upper = amountText(most.toDouble(), unit);
    if (least.isDouble() && most.isDouble())
        return fieldTr("%1 to %2").arg(lower, upper);
    if (least.isDouble())
        return fieldTr("at least %1").arg(lower);
    return most.isDouble() ? fieldTr("at most %1").arg(upper) : QString();
}

QString explanation(const QString &path, const QJsonObject &schema) {
    QStringList lines{schema["description"].toString(), path + ": " + expectation(schema)};
    if (schema["readOnly"].toBool())
        lines.append(fieldTr("is told only, and not set"));
    if (schema.contains("default") && !isSecret(schema))
        lines.append(fieldTr("default %1").arg(shown(schema["default"])));
    if (schema["x-applies"].toString() == "restart")
        lines.append(fieldTr("has effect after a restart"));
    return lines.join('\n');
}

QString faultText(const Faults &faults, const QString &path, const QJsonObject &schema) {
    const auto fault = faultAt(faults, path);
    if (fault == faults.end())
        return {};
    if (fault->first != path) { // of an element or a member
        QStringList place;
        for (const QString &part : fault->first.mid(path.size() + 1).split('.')) {
            bool isRow = false;
            const int row = part.toInt(&isRow);
            place.append(isRow ? fieldTr("row %1").arg(row + 1) : part);
        }
        return fieldTr("%1: expected %2").arg(place.join(", "), fault->second);
    }
    const QString description = schema["description"].toString();
    const bool isPattern = schema.contains("pattern") && fault->second == expectation(schema);
    return fieldTr("expected %1").arg(isPattern && !description.isEmpty() ? description : fault->second);
}

QString numberText(double value) {
    if (value == std::round(value) && std::abs(value) < 9007199254740992) // 2^53
        return QString::number(value, 'f', 0);
    return QString::number(value, 'g', 10);
}

QString spokenAmount(double value, const QString &unit) {
    if ((unit == "B" || unit == "bytes") && value >= 1024 && value < 1e18)
        return sizeText(value);
    return unit == "s" && value >= 120 && value < 1e10 ? durationText(value) : QString();
}

QString jsonText(const QJsonValue &value) {
    if (value.isUndefined())
        return {};
    const QByteArray list = QJsonDocument(QJsonArray{value}).toJson(QJsonDocument::Compact);
    return QString::fromUtf8(list.mid(1, list.size() - 2));
}

QJsonValue fromJson(const QString &text) {
    const QJsonDocument list = QJsonDocument::fromJson("[" + text.toUtf8() + "]");
    return list.array().size() == 1 ? list.array()[0] : QJsonValue(QJsonValue::Undefined);
}

bool losesDigits(const QString &json) {
    static const QRegularExpression longNumber(R"((?<![\w."])-?\d{16,}(?![\w."]))");
    auto found = longNumber.globalMatch(json);
    while (found.hasNext())
        if (const QString digits = found.next().captured();
            QString::number(digits.toDouble(), 'f', 0) != digits)
            return true;
    return false;
}

bool isSecret(const QJsonObject &schema) {
    return schema["writeOnly"].toBool() || schema["format"] == "password";
}

QString summaryOf(const QJsonValue &value) {
    constexpr int maxParts = 6;
    if (value.isString())
        return shortLine(value.toString(), 40);
    if (value.isArray())
        return value.toArray().size() == 1 ? fieldTr("1 entry")
                                           : fieldTr("%1 entries").arg(value.toArray().size());
    if (!value.isObject())
        return value.isUndefined() || value.isNull() ? QString() : shortLine(jsonText(value), 40);
    const QJsonObject object = value.toObject();
    static const QStringList names{"name", "id", "title"}; // by which people know it
    QStringList parts;
    for (const QString &key : names)
        if (object[key].isString())
            parts.append(shortLine(object[key].toString(), 40));
    const bool isNamed = !parts.isEmpty();
    for (auto member = object.begin(); member != object.end() && parts.size() < maxParts; ++member)
        if (!isNamed || !names.contains(member.key()))
            parts.append(shortLine(member.key(), 20) + ": " +
                         (member->isObject() ? fieldTr("%1 values").arg(member->toObject().size())
                                             : summaryOf(member.value())));
    return shortLine(parts.join(", "), 160);
}

int countValues(const QJsonValue &value, int most) {
    int count = 1;
    if (value.isArray()) {
        for (const QJsonValue &element : value.toArray())
            if (count > most)
                break;
            else
                count += countValues(element, most - count);
    } else if (value.isObject()) {
        const QJsonObject object = value.toObject();
        for (auto member = object.begin(); member != object.end() && count <= most; ++member)
            count += countValues(member.value(), most - count);
    }
    return count;
}

} // namespace hermes::desktop
