#pragma once

#include "gui/desktop/model/RecordingStops.h"
#include "gui/session/SessionPlayer.h"

#include <QWidget>

class QAction;
class QLineEdit;
class QPushButton;

namespace hermes::desktop {

class MessageLabel;
class PlainLabel;
class ReplayBar;
class SessionTable;

/// Records with all loggers of the robot as one session, puts marks into it, shows how much and how long the
/// disk will do, lists what was recorded and plays it.
class RecordPanel : public QWidget {
    Q_OBJECT
public:
    /// Of each logger, the newest so many recordings are listed.
    static constexpr int maxRecordings = 200;

    explicit RecordPanel(Fleet &fleet, QWidget *parent = nullptr);
    /// Loggers replay, whoever began it.
    void setReplaying(bool isReplaying);
    SessionPlayer &player() { return player_; }
    /// The chosen robot is recorded, whoever began it.
    bool isRecording() const { return watch_.isRecording(); }

Q_SIGNALS:
    /// The replay of somebody else is to end.
    void liveWanted();
    /// The chosen robot is recorded from now on, or no more.
    void recordingChanged(bool isRecording);

private:
    void layOut();
    void nameAll();
    void connectAll();
    SessionRecorder &recorder();
    void start();
    void stop();
    void showStopped(const QString &text, bool isError, bool isChosen);
    void takeEnd(const QString &session, const QString &name);
    void showEnds();
    void mark();
    QString markText();
    void list();
    void proposeName();
    void play();
    void update();
    void showStop();
    void showAmount();
    void showLost();

    bool isOwnShown() const;

    Fleet &fleet_;
    bool wasRecording_ = false;
    LoggerWatch watch_;
    SessionRecorder recorder_;
    RecordingStops stops_;
    SessionPlayer player_;
    SessionList list_;
    bool isReplaying_ = false;
    int listing_ = 0;             ///< counts the times that it was asked for
    QSet<QString> listed_;        ///< the sessions that were under way then
    QMap<QString, QString> ends_; ///< names of recordings that ended otherwise, by session; to be told
    QString begun_;               ///< what was told of the recording that was begun here last
    QString played_;              ///< the id of the session
    QString playedBy_;            ///< the title of its robot
    QSet<QString> markedIn_;      ///< the sessions that the number is of
    int markNumber_ = 0;          ///< of the last mark
    QLineEdit *name_, *mark_;
    QPushButton *record_, *addMark_, *replay_, *live_;
    QAction *takeMark_;
    PlainLabel *amount_;
    PlainLabel *lost_;
    MessageLabel *message_;
    SessionTable *sessions_;
    ReplayBar *bar_;
};

} // namespace hermes::desktop
