#pragma once

#include "gui/hermesctl/Sessions.h"

#include <QEventLoop>

namespace hermes {

/// Has each logger of a session replay its part, together in time, and brings all back to live at the end.
class Replay {
public:
    Replay(const Loggers &loggers, const Session &session, double speed, bool loop);

    /// Returns at the end of the session, at SIGINT or SIGTERM, or with what failed.
    Result<void> run();

private:
    Result<void> refuseWhileRecording() const;
    Result<void> begin();
    Result<void> follow();
    Result<bool> isAtEnd();
    void wait();
    Result<void> goLive() const;
    void showProgress(double position_s, double duration_s);

    const Loggers &loggers_;
    const Session &session_;
    const double speed_;
    const bool loop_;
    Loggers::Numbers numbers_; ///< of the loggers that take part
    Loggers::Numbers playing_; ///< of those that do not show what is live
    QEventLoop waiting_;
    bool interrupted_ = false;
    bool shown_ = false; ///< a line of progress
};

} // namespace hermes
