#pragma once

#include "daemons/recorder/SessionList.h"

namespace hermes::recorder {

/// What all loggers of a robot do as one. Nothing waits: each ends from the event loop, by the function given
/// with it, whatever the loggers do; not when the context is gone by then.
template <typename T>
using WhenDone = std::function<void(const T &)>;

/// How a session ended.
struct EndedSession {
    std::vector<RecordedPart> parts; ///< as the sidecars have them
    QStringList problems;            ///< what is missing, or does not agree; empty when all is there
};

/// All begin the session of this id, or none does: those that have begun, or may have, are stopped, and the
/// error tells so. Gives the replies to record.start.
void startSession(const SessionMembers &members, const QString &name, const QString &id, QObject *context,
                  const WhenDone<Result<SessionReplies>> &done);
/// Ends a session, and compares what each told at its end with its sidecar. NotReady when nobody records it,
/// and it has not ended by an error.
void stopSession(const SessionMembers &members, const QString &id, QObject *context,
                 const WhenDone<Result<EndedSession>> &done);
void listSessions(const SessionMembers &members, QObject *context, const WhenDone<SessionList> &done);

/// Of a logger the reply to record.stop is waited for so long: everything is to get to the disk.
constexpr std::chrono::minutes stopLimit{2};

} // namespace hermes::recorder
