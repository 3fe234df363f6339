#pragma once

#include "gui/session/SessionList.h"

#include <QTimer>

namespace hermes {

/// Has each logger of a session that can replay its part: all open it and wait, are released together, and
/// receive live again at the end, when one fails, or when they are told to. Nothing waits.
class SessionPlayer : public QObject {
    Q_OBJECT
public:
    struct Options {
        double speed = 1; ///< real time
        bool loop = false;
        std::chrono::milliseconds timeout = Client::defaultTimeout; ///< of a reply
    };

    explicit SessionPlayer(QObject *parent = nullptr);

    /// Ends what is played first. Refused while one of the loggers records.
    void play(const RecordedSession &session, const Options &options);
    /// All are live again soon.
    void end();
    bool isPlaying() const { return isPlaying_; }

Q_SIGNALS:
    void progress(double position_s, double duration_s);
    /// All are live again, after the end of the session or end(); or why it ended before.
    void ended(const hermes::Result<void> &result);

private:
    using Next = void (SessionPlayer::*)(const SessionReplies &);

    void call(const std::vector<SessionCall> &calls, const QString &method, Next next);
    bool goesOn(const Result<void> &result);
    void onStates(const SessionReplies &states);
    void open();
    void onOpened(const SessionReplies &replies);
    void onReleased(const SessionReplies &replies);
    void poll();
    void onPositions(const SessionReplies &replies);
    QString folderOf(const QString &logger) const;
    Result<bool> isAtEnd(const SessionReplies &replies);
    void goLive(const Result<void> &result);

    RecordedSession session_;
    Options options_;
    QTimer timer_;
    std::vector<SessionMember> playing_; ///< who shows what is recorded, or may
    std::optional<std::pair<RecordedSession, Options>> next_;
    bool isPlaying_ = false;
    bool isEnding_ = false;
};

} // namespace hermes
