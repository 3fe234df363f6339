#include "protocol/wire/JsonText.h"

#include "protocol/wire/JsonWriters.h"

#include <QJsonDocument>

namespace hermes {

std::optional<QJsonValue> parseJson(const QByteArray &text, WireError *error) {
    const auto value = WireValue::parse(text, error);
    return value ? std::optional<QJsonValue>(value->toJson()) : std::nullopt;
}

QByteArray compactJson(const QJsonValue &value) {
    JsonTextWriter writer;
    writer.json(value);
    return writer.take();
}

QString indentedJson(const QJsonValue &value) {
    const QByteArray text = value.isObject()  ? QJsonDocument(value.toObject()).toJson().trimmed()
                            : value.isArray() ? QJsonDocument(value.toArray()).toJson().trimmed()
                                              : compactJson(value);
    return QString::fromUtf8(text);
}

} // namespace hermes
