#pragma once

#include <QString>

namespace hermes {

/// Keywords of JSON Schema that lead to schemas of members and elements.
inline const QString itemsKey = QStringLiteral("items");
inline const QString propertiesKey = QStringLiteral("properties");

} // namespace hermes
