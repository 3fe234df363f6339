#pragma once

#include "gui/hermesctl/Loggers.h"

#include <QJsonObject>

namespace hermes {

/// What one logger has of a session: what its record.list tells.
struct SessionPart {
    std::size_t logger = 0; ///< its number
    QJsonObject entry;

    /// Everything that is missing, by the loss counts.
    double lost() const;
    /// "" where all is there, else why not.
    QString fault() const;
};

/// What loggers recorded as one.
struct Session {
    QString id, name;
    double start = 0, end = 0; ///< s since the epoch; end 0: it goes on
    std::vector<SessionPart> parts;
};

/// Those of all loggers, the latest first. What could not be told or read becomes a line of problems.
std::vector<Session> findSessions(const Loggers &loggers, QStringList &problems);

/// A line for each logger that has a sidecar beside those of the session but is none of these loggers.
QStringList absentLoggers(const Loggers &loggers, const Session &session);

/// "data 1800, packets 1810": what is not 0.
QString countsText(const QJsonObject &counts);

} // namespace hermes
