#include "gui/hermesctl/CsvTable.h"

#include "protocol/wire/JsonText.h"

#include <QJsonArray>
#include <QSet>
#include <algorithm>

namespace hermes::ctl {
namespace {

constexpr int maxElements = 64; // of a list with a column for each

QString below(const QString &path, const QString &name) {
    return path.isEmpty() ? name : path + QLatin1Char('.') + name;
}

QString element(const QString &path, int index) {
    return QStringLiteral("%1[%2]").arg(path).arg(index);
}

/// How many elements a list always has; 0: that may change, or they are too many.
int fixedLength(const QJsonObject &schema) {
    const int least = schema[QStringLiteral("minItems")].toInt(-1);
    return least == schema[QStringLiteral("maxItems")].toInt(-2) && least <= maxElements ? std::max(least, 0)
                                                                                         : 0;
}

/// What is no field has the name data; so has what would be called as a column of the message itself.
QString columnName(const QString &path) {
    if (path.isEmpty() || path.startsWith(QLatin1Char('[')))
        return QStringLiteral("data") + path;
    const bool isTaken =
        QStringList{QStringLiteral("stamp"), QStringLiteral("seq"), QStringLiteral("dropped")}.contains(path);
    return isTaken ? QStringLiteral("data.") + path : path;
}

QString fieldText(const QJsonValue &value) {
    if (value.isUndefined() || value.isNull())
        return {};
    return value.isString() ? value.toString() : QString::fromUtf8(compactJson(value));
}

} // namespace

QString csvField(const QString &text) {
    const bool needsQuotes = std::any_of(text.begin(), text.end(), [](QChar c) {
        return c == QLatin1Char(',') || c == QLatin1Char('"') || c == QLatin1Char('\n') ||
               c == QLatin1Char('\r');
    });
    if (!needsQuotes)
        return text;
    return QLatin1Char('"') + QString(text).replace(QLatin1Char('"'), QStringLiteral("\"\"")) +
           QLatin1Char('"');
}

CsvTable::CsvTable(const QJsonObject &schema) {
    addColumns(schema, QString());
}

void CsvTable::add(const Column &column) {
    if (places_.contains(column.path))
        return;
    places_.insert(column.path, columns_.size());
    columns_.append(column);
}

void CsvTable::addVariants(const QJsonArray &variants, const QString &path) {
    for (const QJsonValue &variant : variants)
        if (variant[QStringLiteral("type")].toString() != QStringLiteral("null"))
            addColumns(variant.toObject(), path);
}

void CsvTable::addProperties(const QJsonObject &schema, const QString &path) {
    const QJsonObject properties = schema[QStringLiteral("properties")].toObject();
    for (auto property = properties.begin(); property != properties.end(); ++property)
        addColumns(property.value().toObject(), below(path, property.key()));
    const QJsonValue others = schema[QStringLiteral("additionalProperties")];
    if (others.isObject() || others.toBool(true))
        add({path, QString(), true});
}

void CsvTable::addColumns(const QJsonObject &schema, const QString &path) {
    for (const char *kind : {"anyOf", "oneOf"}) {
        if (schema.contains(QLatin1String(kind)))
            return addVariants(schema[QLatin1String(kind)].toArray(), path);
    }
    const QJsonValue type = schema[QStringLiteral("type")];
    const auto is = [&type](const char *name) {
        return type.toString() == QLatin1String(name) || type.toArray().contains(QLatin1String(name));
    };
    if (is("object"))
        return addProperties(schema, path);
    if (is("array")) {
        const int length = fixedLength(schema);
        if (length > 0)
            elements_.insert(path, length);
        for (int i = 0; i < length; ++i)
            addColumns(schema[QStringLiteral("items")].toObject(), element(path, i));
        if (length > 0)
            return;
    }
    const bool isOpen = type.isUndefined() && !schema.contains(QStringLiteral("enum"));
    add({path, schema[QStringLiteral("unit")].toString(), isOpen});
}

bool CsvTable::isFixed() const {
    return std::none_of(columns_.begin(), columns_.end(), [](const Column &column) { return column.open; });
}

void CsvTable::flatten(const QJsonValue &value, const QString &path,
                       QMap<QString, QJsonValue> &fields) const {
    if (value.isObject()) {
        const QJsonObject object = value.toObject();
        for (auto member = object.begin(); member != object.end(); ++member)
            flatten(member.value(), below(path, member.key()), fields);
        return;
    }
    const QJsonArray list = value.toArray();
    if (value.isArray() && elements_.value(path, -1) == list.size()) {
        for (int i = 0; i < list.size(); ++i)
            flatten(list[i], element(path, i), fields);
        return;
    }
    if (!value.isNull() || places_.contains(path)) // else an object that is not there
        fields.insert(path, value);
}

void CsvTable::begin(const QJsonValue &first) {
    if (isFixed())
        return;
    QMap<QString, QJsonValue> fields;
    flatten(first, QString(), fields);
    const QList<Column> before = std::exchange(columns_, {});
    places_.clear();
    QSet<QString> known;
    for (const Column &column : before)
        if (!column.open)
            known.insert(column.path);
    for (const Column &column : before) {
        if (!column.open) {
            add(column);
            continue;
        }
        for (auto field = fields.begin(); field != fields.end(); ++field) {
            const bool isBelow = column.path.isEmpty() || field.key() == column.path ||
                                 field.key().startsWith(column.path + QLatin1Char('.')) ||
                                 field.key().startsWith(column.path + QLatin1Char('['));
            if (isBelow && !known.contains(field.key()))
                add({field.key(), QString(), false});
        }
    }
}

std::optional<QString> CsvTable::header() const {
    if (!isFixed())
        return std::nullopt;
    QStringList names{QStringLiteral("stamp [s]"), QStringLiteral("seq"), QStringLiteral("dropped")};
    for (const Column &column : columns_)
        names.append(csvField(column.unit.isEmpty()
                                  ? columnName(column.path)
                                  : QStringLiteral("%1 [%2]").arg(columnName(column.path), column.unit)));
    return names.join(QLatin1Char(','));
}

QString CsvTable::line(const QString &stamp, quint64 seq, quint64 dropped, const QJsonValue &data) {
    QMap<QString, QJsonValue> fields;
    flatten(data, QString(), fields);
    QStringList texts{stamp, QString::number(seq), QString::number(dropped)};
    for (const Column &column : qAsConst(columns_))
        texts.append(csvField(fieldText(fields.take(column.path))));
    for (auto field = fields.begin(); field != fields.end(); ++field)
        ++withoutColumn_[columnName(field.key())];
    return texts.join(QLatin1Char(','));
}

} // namespace hermes::ctl
