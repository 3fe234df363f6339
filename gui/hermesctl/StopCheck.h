#pragma once

#include "gui/hermesctl/Sessions.h"

#include <QSet>

namespace hermes {

/// How long everything may take to get to the disk.
constexpr std::chrono::minutes stopLimit{2};

/// Ends the recording of all loggers and compares what each told at its end with what its sidecar says.
class StopCheck {
public:
    explicit StopCheck(const Loggers &loggers)
        : loggers_(loggers) {}

    /// NotReady when nothing is being recorded, and nothing has ended by an error.
    Result<void> stop();
    /// A table: each logger with what it recorded and lost.
    const std::vector<QStringList> &rows() const { return rows_; }
    /// Everything that is missing, or does not agree; empty when all is there.
    const QStringList &problems() const { return problems_; }

private:
    Loggers::Numbers active();
    void verify(const Session &session);
    void verify(const Session &session, const SessionPart &part);

    const Loggers &loggers_;
    QSet<QString> sessions_; ///< that are ended
    std::map<std::size_t, Result<QJsonValue>> ends_;
    std::vector<QStringList> rows_;
    QStringList problems_;
};

} // namespace hermes
