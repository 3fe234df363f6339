#pragma once

#include "gui/desktop/model/LoggerWatch.h"
#include "gui/session/SessionPlayer.h"
#include "gui/session/SessionRecorder.h"

#include <QWidget>

class QLineEdit;
class QPushButton;
class QTreeWidget;

namespace hermes::desktop {

class MessageLabel;
class PlainLabel;

/// Records with all loggers of the robot as one session, puts marks into it, shows how much and how long the
/// disk will do, lists what was recorded and plays it.
class RecordPanel : public QWidget {
    Q_OBJECT
public:
    /// Of each logger, the newest so many recordings are listed.
    static constexpr int mostRecordings = 200;

    explicit RecordPanel(Fleet &fleet, QWidget *parent = nullptr);

private:
    void layOut();
    SessionRecorder &recorder();
    void start();
    void stop();
    void mark();
    void list();
    void play();
    void update();
    void showAmount();
    QString amountText() const;
    void showSessions();

    LoggerWatch watch_;
    SessionRecorder recorder_;
    SessionPlayer player_;
    SessionList list_;
    QLineEdit *name_, *mark_;
    QPushButton *record_, *addMark_, *replay_, *live_;
    PlainLabel *amount_;
    MessageLabel *message_;
    QTreeWidget *sessions_;
};

} // namespace hermes::desktop
