#pragma once

#include "daemons/recorder/SessionMember.h"
#include "protocol/messages/Sessions.h"

namespace hermes::recorder {

/// What one logger has of a session.
struct RecordedPart {
    SessionMember member;
    RecordingEntry entry; ///< of its record.list
    QString error = {};   ///< that ended it; empty: none, or it is not known
    double offset_s = 0;  ///< after the beginning of the session, by a clock that never jumps

    /// How it ended; empty: it goes on.
    QString ended() const { return entry.ended.value_or(std::nullopt).value_or(QString()); }
    bool goesOn() const { return ended().isEmpty(); }
    /// "" where all is there, else why not.
    QString problem() const;
    SessionPart summary() const;
};

/// What loggers recorded as one.
struct RecordedSession {
    QString id, name;
    double start = 0, end = 0; ///< s since the epoch, as the clock was set then; end 0: it goes on
    double duration_s = 0;     ///< by a clock that never jumps
    std::vector<RecordedPart> parts = {};

    /// One more part. No logger has a session twice: a second one counts for nothing.
    void add(RecordedPart part);
    /// Where the recorder's part is, or else that of another.
    QString folder() const;
    QStringList members() const;
    /// A line for each part of which something is missing, and for each logger that has a sidecar beside
    /// those of the session but none of these parts.
    QStringList problems() const;
    bool goesOn() const;
    SessionSummary summary() const;
};

/// Those of all loggers, the latest first.
struct SessionList {
    std::vector<RecordedSession> sessions;
    QStringList problems; ///< a line for each thing that could not be told or read

    /// From the replies to record.list.
    static SessionList of(const SessionReplies &replies);
};

/// A part of which a logger tells this. Numbers that cannot be are brought to what can.
SessionPart sessionPart(const QString &daemon, const QString &state, const QString &problem,
                        std::optional<double> bytes, const std::optional<NamedCounts> &counts,
                        const std::optional<NamedCounts> &losses);

} // namespace hermes::recorder
