#include "protocol/wire/FieldTable.h"

namespace hermes {

void FieldTable::add(const char *name, std::size_t offset, const MemberType &type, const char *description,
                     const char *unit) {
    entries_.push_back({name, offset, &type});
    QJsonObject &keywords = entries_.back().keywords;
    keywords.insert(QStringLiteral("description"), QString::fromUtf8(description));
    if (*unit)
        keywords.insert(QStringLiteral("unit"), QString::fromUtf8(unit));
}

void FieldTable::include(const FieldTable &part, std::size_t offset) {
    for (Entry entry : part.entries_) {
        entry.offset += offset;
        entries_.push_back(std::move(entry));
    }
}

void FieldTable::write(WireWriter &out, const void *message) const {
    out.beginObject();
    for (const Entry &entry : entries_) {
        const bool isEmpty = entry.isOptional() && entry.type->isEmpty(entry.of(message));
        if (isEmpty && !entry.isNullable)
            continue;
        out.key(QLatin1String(entry.name));
        isEmpty ? out.null() : entry.type->write(out, entry.of(message));
        if (out.hasRefused())
            return out.within(QLatin1String(entry.name));
    }
    out.endObject();
}

void FieldTable::read(WireView in, void *message, ReadReport &report) const {
    if (in.kind() != WireView::Kind::Object)
        return report.fail(in, QStringLiteral("an object"));
    std::size_t known = 0;
    for (const Entry &entry : entries_) {
        const WireView value = in[entry.name.constData()];
        known += value.kind() != WireView::Kind::Undefined;
        const bool isMissing = value.kind() == WireView::Kind::Undefined;
        if ((isMissing && (entry.isOptional() || entry.mayBeMissing)) ||
            (entry.isNullable && value.kind() == WireView::Kind::Null))
            continue;
        entry.type->read(value, entry.of(message), entry.limits, report);
        if (report.hasFailed())
            return report.within(QLatin1String(entry.name));
    }
    report.unknown += in.size() - known;
}

QJsonObject orNull(QJsonObject schema) {
    const QJsonValue type = schema.value(QStringLiteral("type"));
    if (type.isString())
        schema.insert(QStringLiteral("type"), QJsonArray{type, QStringLiteral("null")});
    QJsonArray choices = schema.value(QStringLiteral("enum")).toArray();
    if (!choices.isEmpty()) {
        choices.append(QJsonValue::Null);
        schema.insert(QStringLiteral("enum"), choices);
    }
    return schema;
}

QJsonObject FieldTable::schemaOf(const Entry &entry) {
    QJsonObject schema = entry.type->schema(entry.limits);
    for (auto keyword = entry.keywords.begin(); keyword != entry.keywords.end(); ++keyword)
        schema.insert(keyword.key(), keyword.value());
    return entry.isNullable ? orNull(schema) : schema;
}

QJsonObject FieldTable::schema() const {
    QJsonObject properties;
    QJsonArray required;
    for (const Entry &entry : entries_) {
        properties.insert(QLatin1String(entry.name), schemaOf(entry));
        if (!entry.isOptional() || entry.isNullable)
            required.append(QLatin1String(entry.name));
    }
    return objectSchema(properties, required);
}

QJsonObject objectSchema(const QJsonObject &properties, const QJsonArray &required) {
    QJsonObject schema{{QStringLiteral("type"), QStringLiteral("object")},
                       {QStringLiteral("properties"), properties},
                       {QStringLiteral("additionalProperties"), false}};
    if (!required.isEmpty())
        schema.insert(QStringLiteral("required"), required);
    return schema;
}

} // namespace hermes
