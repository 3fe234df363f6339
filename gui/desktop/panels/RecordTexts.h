#pragma once

#include "gui/desktop/model/LoggerWatch.h"
#include "gui/session/SessionList.h"

namespace hermes::desktop {

// What the panel of recordings says of the loggers.

/// What is recorded, or with which loggers it would be.
QString amountText(const LoggerWatch &watch, const SessionList &list);
/// A line for each logger that was gone while it recorded.
QString lostText(const LoggerWatch &watch);
/// That the session (an id) was ended by others, by whom of the loggers where it goes on; name: of the
/// recording. Then a line for each logger that ended it without being told to.
QStringList endLines(const QString &session, const QString &name, const LoggerWatch &watch,
                     const SessionList &list);

} // namespace hermes::desktop
