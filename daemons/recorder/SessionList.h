#pragma once

#include "daemons/recorder/SessionMember.h"

namespace hermes::recorder {

/// What one logger has of a session: an entry of its record.list.
struct RecordedPart {
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
    std::vector<RecordedPart> parts;

    /// Where the recorder's part is, or else that of another.
    QString folder() const;
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

    /// From the replies to record.list.
    static SessionList of(const SessionReplies &replies);
};

/// "data 1800, packets 1810": what is not 0.
QString countsText(const QJsonValue &counts);
/// The sum of counts.
double sumOf(const QJsonValue &counts);

} // namespace hermes::recorder
