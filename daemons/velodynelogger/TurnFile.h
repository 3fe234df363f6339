#pragma once

#include "common/Result.h"
#include "daemons/velodynelogger/TurnText.h"

#include <QString>

namespace hermes::velodynelogger {

/// The path of a new file NAME.SUFFIX in a folder; makes the folder where it is missing. Refuses names that
/// lead out of it (InvalidParams) and files that exist (InputOutput, data.path).
Result<QString> newTurnFile(const QString &folder, const QString &name, const QString &suffix);

/// Writes a turn to a new file. It appears under its name when it is complete; a file that exists is not
/// touched. InputOutput with data.path on failure.
Result<void> writeTurn(const QString &path, const velodyne::Turn &turn, TurnFormat format);

} // namespace hermes::velodynelogger
