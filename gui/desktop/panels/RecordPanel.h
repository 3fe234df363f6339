#pragma once

#include "gui/desktop/model/RecordingStop.h"
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
    static constexpr int mostRecordings = 200;

    explicit RecordPanel(Fleet &fleet, QWidget *parent = nullptr);
    /// Loggers replay, whoever began it.
    void setReplaying(bool isReplaying);

Q_SIGNALS:
    /// The replay of somebody else is to end.
    void liveWanted();

private:
    void layOut();
    void nameAll();
    void connectAll();
    SessionRecorder &recorder();
    void start();
    void stop();
    void showEnd(const QStringList &problems);
    void mark();
    QString markText();
    void list();
    void proposeName();
    void play();
    void update();
    void showStop();
    void showAmount();
    void showLost();
    QString amountText() const;

    LoggerWatch watch_;
    SessionRecorder recorder_;
    RecordingStop stop_{watch_};
    SessionPlayer player_;
    SessionList list_;
    bool isReplaying_ = false;
    int listing_ = 0;        ///< counts the times that it was asked for
    QString played_;         ///< the id of the session
    QSet<QString> markedIn_; ///< the sessions that the number is of
    int markNumber_ = 0;     ///< of the last mark
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
