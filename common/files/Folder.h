#pragma once

#include "common/Result.h"

#include <QString>

namespace hermes {

/// Makes a folder with those above it, where it is missing. Error: InputOutput, with why it cannot be made.
Result<void> makeFolder(const QString &path);

} // namespace hermes
