#include "daemons/web/PlainJson.h"

#include "protocol/wire/JsonWriters.h"

namespace hermes::web {
namespace {

/// The types that a schema permits, but for null.
QStringList typesOf(const QJsonObject &schema) {
    QStringList types = schema["type"].isString() ? QStringList{schema["type"].toString()}
                                                  : schema["type"].toVariant().toStringList();
    types.removeAll("null");
    return types;
}

bool mayBeNull(const QJsonObject &schema) {
    return schema["type"].toArray().contains("null");
}

/// Nothing: it cannot be told.
std::optional<QJsonObject> told(const QJsonObject &schema, bool isElement = false) {
    const QStringList types = typesOf(schema);
    if (types.size() != 1 || (isElement && (types[0] == "array" || mayBeNull(schema))))
        return {};
    QJsonObject plain{{"type", types[0]}};
    const QString unit = schema["unit"].toString(), what = schema["description"].toString();
    if (!what.isEmpty())
        plain["description"] = unit.isEmpty() ? what : QString("%1 (%2)").arg(what, unit);
    if (types[0] == "array") {
        const auto items = told(schema["items"].toObject(), true);
        if (!items)
            return {};
        plain["items"] = *items;
    }
    if (types[0] == "object") {
        QJsonObject properties;
        QJsonArray required;
        const QJsonObject all = schema["properties"].toObject();
        for (auto one = all.begin(); one != all.end(); ++one) {
            const QJsonObject member = one->toObject();
            const auto property = told(member);
            if (property)
                properties[one.key()] = *property;
            if (property && !mayBeNull(member) && schema["required"].toArray().contains(one.key()))
                required.append(one.key());
        }
        plain["properties"] = properties;
        if (!required.isEmpty())
            plain["required"] = required;
    }
    return plain;
}

/// Leaves out members that are null.
class PlainWriter : public JsonTextWriter {
public:
    void key(const QString &name) override { key_ = name; }
    void null() override {
        if (!std::exchange(key_, {}))
            JsonTextWriter::null();
    }
    void beginObject() override { begin(), JsonTextWriter::beginObject(); }
    void beginArray() override { begin(), JsonTextWriter::beginArray(); }
    void boolean(bool value) override { begin(), JsonTextWriter::boolean(value); }
    void integer(qint64 value) override { begin(), JsonTextWriter::integer(value); }
    void text(const QString &value) override { begin(), JsonTextWriter::text(value); }

protected:
    void finite(double value) override { begin(), JsonTextWriter::finite(value); }
    void finite(float value) override { begin(), JsonTextWriter::finite(value); }

private:
    void begin() {
        if (const auto name = std::exchange(key_, {}))
            JsonTextWriter::key(*name);
    }

    std::optional<QString> key_; ///< of the value to come
};

} // namespace

QJsonObject plainSchema(const QJsonObject &schema) {
    if (typesOf(schema) == QStringList{"object"})
        return *told(schema);
    QJsonObject properties;
    if (const auto value = told(schema))
        properties["value"] = *value;
    return {{"type", "object"}, {"properties", properties}};
}

QByteArray plainJson(WireView value, bool isReplayed) {
    PlainWriter writer;
    writer.beginObject();
    if (isReplayed) {
        writer.key("replayed");
        writer.boolean(true);
    }
    const bool isObject = value.kind() == WireView::Kind::Object;
    if (isObject)
        value.forEachMember([&](const QString &name, WireView member) {
            if (isReplayed && name == "replayed")
                return;
            writer.key(name);
            member.write(writer);
        });
    else {
        writer.key("value");
        value.write(writer);
    }
    writer.endObject();
    return writer.take();
}

} // namespace hermes::web
