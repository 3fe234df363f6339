#pragma once

#include <QJsonObject>

namespace hermes::web {

/// The JSON Schema of messages that Foxglove and Lichtblick have panels for, by name without "foxglove.":
/// those of the views. All members are required; lengths in metres, angles in radians.
QJsonObject foxgloveSchema(const QString &name);

} // namespace hermes::web
