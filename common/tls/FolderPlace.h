#pragma once

#include <QString>

namespace hermes {

/// Renames a folder; it takes the place of an empty one, too, but of nothing else. False: qt_error_string()
/// tells why, and an empty one is still there.
bool takePlace(const QString &folder, const QString &place);

/// Whether the system says that nothing has this name: not so where it cannot tell.
bool isAbsent(const QString &path);

} // namespace hermes
