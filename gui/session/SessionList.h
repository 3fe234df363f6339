#pragma once

#include "gui/session/SessionMember.h"

namespace hermes {

/// What one logger has of a session: an entry of its record.list.
struct SessionPart {
    SessionMember member;
    QJsonObject entry;

    bool goesOn() const { return !entry["ended"].isString(); }
    /// "" where all is there, else why not.
    QString fault() const;
};

/// What loggers recorded as one.
struct RecordedSession {
    QString id, name;
    double start = 0, end = 0; ///< s since the epoch; end 0: it goes on
    std::vector<SessionPart> parts;

    double bytes() const;
    QStringList members() const;
    /// "velodynelogger cut off" for each part of which something is missing.
    QStringList faults() const;
    bool goesOn() const;
    /// A line for each logger that has a sidecar beside those of the session but none of these parts.
    QStringList absent() const;
};

/// Those of all loggers, the latest first.
struct SessionList {
    std::vector<RecordedSession> sessions;
    QStringList problems; ///< a line for each thing that could not be told or read
    int unlisted = 0;     ///< older recordings than the newest of a logger that are here

    /// From the replies to record.list. most: of each logger only the newest so many; 0: all.
    static SessionList of(const SessionReplies &replies, int most = 0);
};

/// "data 1800, packets 1810": what is not 0.
QString countsText(const QJsonValue &counts);
/// The sum of counts.
double sumOf(const QJsonValue &counts);

} // namespace hermes
