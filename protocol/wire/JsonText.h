#pragma once

#include "protocol/wire/WireValue.h"

namespace hermes {

/// Strictly, as WireValue::parse() does it.
std::optional<QJsonValue> parseJson(const QByteArray &text, WireError *error);

/// One value as compact JSON on one line; null in the place of what JSON cannot carry.
QByteArray compactJson(const QJsonValue &value);
/// The same, but objects and lists over several lines.
QString indentedJson(const QJsonValue &value);

} // namespace hermes
