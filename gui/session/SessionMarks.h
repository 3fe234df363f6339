#pragma once

#include "gui/session/SessionList.h"

namespace hermes {

/// What was marked while a session was recorded.
struct SessionMark {
    double t_s = 0; ///< of the session
    QString text;
};

/// Asks the loggers of a session for its marks. done gets them in the order of their times, and a line for
/// each logger that did not tell.
void listMarks(
    const RecordedSession &session, std::chrono::milliseconds timeout, QObject *context,
    const std::function<void(const std::vector<SessionMark> &, const QStringList &problems)> &done);

} // namespace hermes
