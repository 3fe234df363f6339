#include "protocol/wire/JsonText.h"

#include "protocol/wire/JsonWriters.h"

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

} // namespace hermes
