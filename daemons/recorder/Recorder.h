#pragma once

#include "common/daemon/Daemon.h"
#include "common/recording/Recording.h"
#include "common/recording/ReplaySource.h"
#include "daemons/recorder/SessionControl.h"
#include "daemons/recorder/SessionReader.h"
#include "daemons/recorder/TopicPlayer.h"
#include "daemons/recorder/TopicRecorder.h"
#include "daemons/recorder/TopicReturn.h"

#include <QThreadPool>
#include <atomic>

namespace hermes::recorder {

/// hermes-recorder: the sessions of a robot. All loggers record and replay as one, and every topic of every
/// daemon is recorded beside them.
class Recorder : public Daemon {
public:
    Recorder();

protected:
    Result<void> start() override;
    void stop() override;
    void settingsChanged(const QStringList &paths) override;

private:
    void declareSettings();
    void declareCommands();
    void declareReplay();
    void declareStudies();
    /// Declares what its own part of a session offers to the session alone.
    void declareOwnCommands();
    SessionMember ownMember();
    ReplaySource::Actions sourceActions();
    void follow();
    QStringList notReplayed();
    Result<SessionMark> mark(const QString &text);
    QString endedPath();
    void keepEnded(const QString &session);
    void recordingChanged();
    void resume(const QJsonObject &latest, double since_s);
    void openRing();
    /// Keeps what the ring has as a session, and what comes for some seconds.
    void keepRing(const QString &why);
    void sessionChanged();
    void updateHealth();

    /// Does the work with the session of that name in another thread; refused while it is recorded or
    /// replayed.
    void change(const QString &name, const Reply &reply,
                std::function<Result<QJsonValue>(const RecordedSession &)> work);
    /// Does the work with what a session holds in a thread of the pool, also while it is recorded.
    void study(QThreadPool &pool, const QString &name, const Reply &reply,
               std::function<Result<QJsonValue>(SessionReader &)> work);
    /// Has the marks of what is replayed told, and answers.
    void showMarks(const QString &name, const Reply &reply);
    /// Does one thing to a replay; refused when there is none.
    Command whileReplaying(Command command, const std::function<Result<void>(const Call &)> &action);

    RobotDaemons daemons_;
    McapRecorder file_;
    Recording recording_;
    TopicRecorder topics_{daemons_, file_};
    TopicPlayer player_;
    TopicReturn return_;
    ReplaySource source_{"topics", identity().name, settings(), player_.playback(), sourceActions()};
    CommandRegistry own_;
    SessionControl session_;
    bool keepsRing_ = false; ///< the recording that begins is to have what is in the ring
    QTimer ringEnd_;
    QString ringSession_; ///< its id
    std::atomic<bool> isEnding_{false};
    double duration_s_ = 0; ///< of what is replayed
    QThreadPool work_;      ///< reads
    QThreadPool exports_;   ///< one after another: those of one session write the same files
    QThreadPool changes_;   ///< renames and removes
};

} // namespace hermes::recorder
