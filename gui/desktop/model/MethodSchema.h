#pragma once

#include <QJsonObject>

namespace hermes::desktop {

/// The parameters of a method as one object's schema.
QJsonObject parametersOf(const QJsonObject &method);

} // namespace hermes::desktop
