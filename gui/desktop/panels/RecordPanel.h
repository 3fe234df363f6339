#pragma once

#include "gui/desktop/model/SessionPlayer.h"
#include "gui/desktop/model/SessionRecorder.h"

#include <QWidget>

class QLineEdit;
class QPushButton;
class QTreeWidget;

namespace hermes {

class MessageLabel;
class PlainLabel;

/// Records with all loggers of the robot under one name, shows how much and how long the disk will do, and
/// lists what was recorded.
class RecordPanel : public QWidget {
    Q_OBJECT
public:
    explicit RecordPanel(Fleet &fleet, QWidget *parent = nullptr);

private:
    void update();
    void showAmount();
    void showSessions();

    SessionRecorder recorder_;
    SessionPlayer player_;
    QLineEdit *name_;
    QPushButton *record_, *replay_, *live_;
    PlainLabel *amount_;
    MessageLabel *message_;
    QTreeWidget *sessions_;
};

} // namespace hermes
