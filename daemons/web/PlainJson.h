#pragma once

#include "protocol/wire/WireValue.h"

#include <QJsonObject>

namespace hermes::web {

/// A JSON Schema as the parsers of Foxglove and Lichtblick take it: an object whose members have one type
/// each, without null, choices and lists of lists. Members that cannot be told so are left out; they may come
/// all the same. A value that is no object becomes the member `value` of one.
QJsonObject plainSchema(const QJsonObject &schema);

/// The value as that schema tells it: an object without members that are null. isReplayed adds that it was
/// recorded, and says nothing of now.
QByteArray plainJson(WireView value, bool isReplayed);

} // namespace hermes::web
