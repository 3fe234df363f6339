#pragma once

#include "daemons/recorder/SessionReader.h"

#include <optional>

namespace hermes::recorder {

/// Everything that is known of a session, from one look at all its messages.
SessionInfo sessionInfo(SessionReader &session);

/// The first 1000 texts that somebody put into it.
std::vector<SessionMark> sessionMarks(SessionReader &session);

/// A page of plain text about a moment of a session: why the robot stopped, who drove it, what was commanded
/// and measured, what happened around that and what was wrong then. at_s: after the beginning of the session;
/// nothing: its last stop or fault, or the whole of it where there was none. NotReady: the session has no
/// messages.
Result<QString> explainSession(SessionReader &session, std::optional<double> at_s);

} // namespace hermes::recorder
