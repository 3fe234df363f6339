#pragma once

#include "common/Result.h"
#include "daemons/velodynelogger/TurnText.h"

#include <QString>

namespace hermes::velodynelogger {

/// Writes a turn to a new file. It appears under its name when it is complete; a file that exists is not
/// touched. InputOutput with data.path on failure.
Result<void> writeTurn(const QString &path, const velodyne::Turn &turn, TurnFormat format);

} // namespace hermes::velodynelogger
