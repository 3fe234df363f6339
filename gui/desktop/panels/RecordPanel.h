#pragma once

#include "gui/desktop/model/Sessions.h"
#include "gui/desktop/widgets/OneDialog.h"

#include <QWidget>

class QAction;
class QLineEdit;
class QPushButton;

namespace hermes::desktop {

class MessageLabel;
class PlainLabel;
class SessionTable;

/// Has the recorder of the robot record sessions, puts marks into them, shows how much and how long the disk
/// will do, lists what was recorded, plays it and tells what happened in it.
class RecordPanel : public QWidget {
    Q_OBJECT
public:
    /// The newest so many sessions are listed.
    static constexpr int maxSessions = 200;

    RecordPanel(Fleet &fleet, Sessions &sessions, QWidget *parent = nullptr);

private:
    using Taken = std::function<void(const QJsonValue &)>;

    void layOut();
    void addActions();
    void connectAll();
    void addHand(const QString &text, const char *name, const std::function<void()> &work);
    /// Asks the recorder, and shows why it was refused.
    void ask(const QString &method, const QJsonObject &params, const Taken &taken = {});
    /// The same of the chosen session.
    void askOfChosen(const QString &method, QJsonObject params, const Taken &taken = {});
    void startRecorder();
    void record();
    void mark();
    void list();
    void remove();
    void replay();
    void explain();
    void update();
    QString amount() const;
    QString wrong() const;

    Fleet &fleet_;
    Sessions &sessions_;
    OneDialog dialog_;
    QString listedFor_; ///< what the recorder did as it was asked for the list
    int listing_ = 0;   ///< counts the times that it was asked
    QString recorded_;  ///< the id of the session that is recorded
    int marks_ = 0;     ///< in it, with those that are on their way
    QLineEdit *name_, *mark_;
    QPushButton *record_, *addMark_, *replay_, *live_, *explain_, *startRecorder_;
    QAction *takeMark_;
    PlainLabel *amount_, *wrong_;
    MessageLabel *message_;
    SessionTable *table_;
};

} // namespace hermes::desktop
