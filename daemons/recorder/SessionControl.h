#pragma once

#include "daemons/recorder/SessionCommands.h"
#include "daemons/recorder/SessionMember.h"
#include "daemons/recorder/SessionPlayer.h"
#include "protocol/messages/Sessions.h"

#include <deque>

namespace hermes::recorder {

/// The session of a robot, from its begin to its end, whoever asked for it and whoever has gone since. All
/// loggers record it, also those that come later; one that missed its end is told when it is back. And its
/// replay.
class SessionControl : public QObject {
    Q_OBJECT
public:
    template <typename T>
    using Done = std::function<void(const Result<T> &)>;

    /// own: what the recorder itself records and replays.
    SessionControl(RobotDaemons &daemons, const SessionMember &own);

    /// what: the names of the loggers; empty: all. name: empty: that of the time.
    void start(const QString &name, const QStringList &what, const Done<SessionState> &done);
    void stop(const Done<SessionState> &done);
    /// Gives the mark, which is also in what all loggers that take marks record.
    Result<SessionMark> mark(const QString &text);
    /// The latest first.
    void list(const WhenDone<SessionList> &done);
    /// The one of this name. InvalidParams: there is none.
    void find(const QString &name, const Done<RecordedSession> &done);

    void replay(const QString &name, const SessionPlayer::Options &options, const Done<SessionState> &done);
    /// Ends the replay; done is told when all are live.
    void live(const Done<SessionState> &done);
    SessionPlayer &player() { return player_; }
    /// Of what is replayed.
    void setMarks(const std::vector<SessionMark> &marks);
    bool isReplaying() const { return player_.isPlaying(); }
    /// A session is being recorded, or about to be.
    bool isBusy() const { return phase_ != Phase::Idle; }
    bool isOf(const RecordedSession &session) const;
    /// Goes on with a session that nobody stopped: all loggers record it again. status: what
    /// is known of it.
    void resume(const RecordingStatus &status);
    /// Ids of sessions that have ended before this program began.
    void setEnded(const QStringList &sessions) { ended_ = {sessions.begin(), sessions.end()}; }

    SessionState state() const;

Q_SIGNALS:
    void changed();
    /// Its id: nobody is to go on with it.
    void sessionEnded(const QString &session);
    /// A session goes on that was recorded before this program began.
    void resumed(const QString &name);

private:
    enum class Phase { Idle, Starting, Recording, Stopping };

    SessionMembers members() const;
    SessionMembers allMembers() const;
    void begun(const SessionReplies &replies);
    void forget(const QString &name);
    void askHowTheyAre(const std::function<void()> &done);
    void watch();
    void tellLate();
    void take(const SessionReplies &states);
    void ended(const Result<EndedSession> &result);
    void greet(RobotDaemons::Daemon *daemon);
    void join(const SessionReply &reply);
    void missed(const QString &line);
    void problem(const QString &line);
    Result<void> mayReplay() const;
    void keep(const SessionReply &reply);

    RobotDaemons &daemons_;
    const SessionMember own_;
    SessionPlayer player_;
    QTimer second_;

    Phase phase_ = Phase::Idle;
    QStringList what_;
    SessionState now_;    ///< of what is recorded or replayed, or was last; state() completes it
    QSet<QString> ended_; ///< ids of sessions that have ended
    QSet<QString> late_;  ///< names of loggers that have not been told so
    double startMono_ = 0;
    std::map<QString, SessionPart> parts_;           ///< by the name of the logger
    std::map<QString, double> free_;                 ///< bytes, by the same
    std::deque<std::pair<double, double>> progress_; ///< monotonic seconds, bytes
    double position_s_ = 0, length_s_ = 0;           ///< of the replay
    std::vector<Done<SessionState>> toBeLive_;       ///< who waits for its end
};

} // namespace hermes::recorder
