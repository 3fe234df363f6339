#include "gui/hermesctl/CsvTable.h"

#include "protocol/wire/JsonText.h"

#include <QJsonArray>
#include <QSet>
#include <algorithm>

namespace hermes::ctl {
namespace {

constexpr int maxElements = 64; // of a list with a column for each

QString below(const QString &path, const QString &name) {
    return path.isEmpty() ? name : path + '.' + name;
}

QString element(const QString &path, int index) {
    return QString("%1[%2]").arg(path).arg(index);
}

/// How many elements a list always has; 0: that may change, or they are too many.
int fixedLength(const QJsonObject &schema) {
    const int least = schema["minItems"].toInt(-1);
    return least == schema["maxItems"].toInt(-2) && least <= maxElements ? std::max(least, 0) : 0;
}

/// What is no field has the name data; so has what would be called as a column of the message itself.
QString columnName(const QString &path) {
    if (path.isEmpty() || path.startsWith('['))
        return "data" + path;
    const bool isTaken = QStringList{"stamp", "seq", "dropped"}.contains(path);
    return isTaken ? "data." + path : path;
}

QString fieldText(const QJsonValue &value) {
    if (value.isUndefined() || value.isNull())
        return {};
    return value.isString() ? value.toString() : QString::fromUtf8(compactJson(value));
}

} // namespace

QString csvField(const QString &text) {
    const bool needsQuotes = std::any_of(
        text.begin(), text.end(), [](QChar c) { return c == ',' || c == '"' || c == '\n' || c == '\r'; });
    if (!needsQuotes)
        return text;
    return '"' + QString(text).replace('"', "\"\"") + '"';
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
        if (variant["type"].toString() != "null")
            addColumns(variant.toObject(), path);
}

void CsvTable::addProperties(const QJsonObject &schema, const QString &path) {
    const QJsonObject properties = schema["properties"].toObject();
    for (auto property = properties.begin(); property != properties.end(); ++property)
        addColumns(property.value().toObject(), below(path, property.key()));
    const QJsonValue others = schema["additionalProperties"];
    if (others.isObject() || others.toBool(true))
        add({path, QString(), true});
}

void CsvTable::addColumns(const QJsonObject &schema, const QString &path) {
    for (const char *kind : {"anyOf", "oneOf"}) {
        if (schema.contains(kind))
            return addVariants(schema[kind].toArray(), path);
    }
    const QJsonValue type = schema["type"];
    const auto is = [&type](const char *name) {
        return type.toString() == name || type.toArray().contains(name);
    };
    if (is("object"))
        return addProperties(schema, path);
    if (is("array")) {
        const int length = fixedLength(schema);
        if (length > 0)
            elements_.insert(path, length);
        for (int i = 0; i < length; ++i)
            addColumns(schema["items"].toObject(), element(path, i));
        if (length > 0)
            return;
    }
    const bool isOpen = type.isUndefined() && !schema.contains("enum");
    add({path, schema["unit"].toString(), isOpen});
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
                                 field.key().startsWith(column.path + '.') ||
                                 field.key().startsWith(column.path + '[');
            if (isBelow && !known.contains(field.key()))
                add({field.key(), QString(), false});
        }
    }
}

std::optional<QString> CsvTable::header() const {
    if (!isFixed())
        return std::nullopt;
    QStringList names{"stamp [s]", "seq", "dropped"};
    for (const Column &column : columns_)
        names.append(csvField(column.unit.isEmpty()
                                  ? columnName(column.path)
                                  : QString("%1 [%2]").arg(columnName(column.path), column.unit)));
    return names.join(',');
}

QString CsvTable::line(const QString &stamp, quint64 seq, quint64 dropped, const QJsonValue &data) {
    QMap<QString, QJsonValue> fields;
    flatten(data, QString(), fields);
    QStringList texts{stamp, QString::number(seq), QString::number(dropped)};
    for (const Column &column : qAsConst(columns_))
        texts.append(csvField(fieldText(fields.take(column.path))));
    for (auto field = fields.begin(); field != fields.end(); ++field)
        ++withoutColumn_[columnName(field.key())];
    return texts.join(',');
}

} // namespace hermes::ctl
