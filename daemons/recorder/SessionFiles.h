#pragma once

#include "daemons/recorder/SessionList.h"

namespace hermes::recorder {

/// Gives the folder of a session below the root another name, and the sidecars in it. Blocks. InputOutput: a
/// part lies elsewhere, and nothing was changed, or it failed, and the message tells where.
Result<void> renameSession(const RecordedSession &session, const QString &root, const QString &to);
/// Removes the folder of a session below the root with all that is in it. Blocks. InputOutput as above.
Result<void> removeSession(const RecordedSession &session, const QString &root);

} // namespace hermes::recorder
