#pragma once

#include "common/Result.h"

#include <QString>

namespace hermes {

/// Makes a folder with those above it, where it is missing. Error: InputOutput, with why it cannot be made.
Result<void> makeFolder(const QString &path);

/// Where programs keep what outlives them: $STATE_DIRECTORY of the service manager, else hermes in the user's
/// folder of state.
QString stateFolder();

} // namespace hermes
