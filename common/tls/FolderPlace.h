#pragma once

#include <QString>

namespace hermes {

/// Renames a folder; it takes the place of an empty one, too, but of nothing else. False: qt_error_string()
/// tells why.
bool takePlace(const QString &folder, const QString &place);

} // namespace hermes
