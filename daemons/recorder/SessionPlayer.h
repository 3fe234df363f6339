#pragma once

#include "daemons/recorder/SessionList.h"

#include <QTimer>
#include <optional>

namespace hermes::recorder {

/// Has each logger of a session that can replay its part: all open it and wait, are released together, and
/// receive live again at the end, when one fails, or when they are told to. What is ordered while it plays
/// goes to all of them, one order after the other, the newest of each kind. Nothing waits.
class SessionPlayer : public QObject {
    Q_OBJECT
public:
    struct Options {
        double speed = 1;  ///< real time
        double from_s = 0; ///< of the session
        bool loop = false, paused = false;
        std::chrono::milliseconds timeout = Client::defaultTimeout; ///< of a reply
        QStringList without;                                        ///< daemons whose topics stay live
    };

    explicit SessionPlayer(QObject *parent = nullptr);

    /// While nothing is played. Refused while one of the loggers records.
    void play(const RecordedSession &session, const Options &options);
    /// All are live again soon.
    void end();
    bool isPlaying() const { return isPlaying_; }
    const Options &options() const { return options_; }
    const RecordedSession &session() const { return session_; }

    /// To a time of the session; those that have come to their end begin anew. NotReady: one of them cannot.
    Result<void> seek(double t_s);
    /// While they wait, the end of the recording does not end the replay.
    void setPaused(bool isPaused);
    bool isPaused() const { return pauseWanted_.value_or(isPaused_); }
    /// NotReady: one of them cannot.
    Result<void> setSpeed(double speed);
    /// At the end all begin anew.
    void setLoop(bool isLoop) { options_.loop = isLoop; }

Q_SIGNALS:
    /// Of the session; not while it is sought. 0: not known.
    void progress(double position_s, double duration_s);
    /// All are live again, after the end of the session or end(); or why it ended before.
    void ended(const hermes::Result<void> &result);

private:
    using Next = void (SessionPlayer::*)(const SessionReplies &);
    Result<void> haveAll(bool SessionMember::*what, const QString &text) const;
    void call(const std::vector<SessionCall> &calls, const QString &method, Next next);
    bool goesOn(const Result<void> &result);
    void onStates(const SessionReplies &states);
    void open();
    void onOpened(const SessionReplies &replies);
    void onPlaced(const SessionReplies &replies);
    void obeySoon();
    void order(const QString &method, const QJsonObject &params, Next next);
    void orderPause();
    void onObeyed(const SessionReplies &replies);
    void onSought(const SessionReplies &replies);
    bool hasOrders() const;
    void poll();
    void onPositions(const SessionReplies &replies);
    QString folderOf(const QString &logger) const;
    Result<bool> isAtEnd(const SessionReplies &replies);
    void goLive(const Result<void> &result);

    RecordedSession session_;
    Options options_;
    QTimer timer_;
    std::vector<SessionMember> playing_; ///< who shows what is recorded, or may
    std::optional<double> seekWanted_, speedWanted_;
    std::optional<bool> pauseWanted_;
    double begin_s_ = 0;             ///< where those that are opened begin
    std::optional<double> sought_s_; ///< since the last positions
    bool reopens_ = false;           ///< one had come to its end and could not be sought
    bool isPaused_ = false;
    bool isPlaying_ = false;
    bool isEnding_ = false;
};

} // namespace hermes::recorder
