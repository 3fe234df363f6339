#pragma once

#include "gui/desktop/drive/DriveControl.h"
#include "gui/desktop/drive/LatchWatch.h"
#include "gui/desktop/model/Macro.h"

namespace hermes::desktop {

/// Runs the operator's buttons, one at a time: each command after the answer to the one before. It ends at
/// the first error, when it is told to, with every STOP of this window, and with every stop of the chosen
/// robot and of those that its commands go to. It takes no control.
class MacroRunner : public QObject {
    Q_OBJECT
public:
    MacroRunner(Fleet &fleet, DriveControl &drive, QObject *parent = nullptr);

    /// The name of the first daemon of it that is not connected; empty: all are.
    QString away(const Macro &macro) const;
    /// Why it cannot run now; empty: it can, for all that is known here.
    QString hindrance(const Macro &macro) const;
    /// What it replaces or forgets; empty: nothing.
    QStringList destroys(const Macro &macro) const;

    /// Nothing while one runs, or where something hinders it.
    void run(const Macro &macro);
    void end(const QString &why);
    bool isRunning() const { return !macro_.steps.empty(); }
    /// How far it is, or how the last one ended.
    const QString &text() const { return text_; }
    bool hasFailed() const { return hasFailed_; }

Q_SIGNALS:
    void changed();

private:
    void next();
    void send();
    void onAnswer(const Result<QJsonValue> &result);
    void finish(const QString &text, bool hasFailed);
    /// "step 2 of 3, motorcontrol, motor.stop"; of a single command only the command.
    QString place() const;
    /// "at step 2 of 3, ...", "before" what was not sent.
    QString where() const;

    Fleet &fleet_;
    DriveControl &drive_;
    LatchWatch stops_; // of the robots that it goes to
    Macro macro_;      // that runs; without steps: none
    std::size_t step_ = 0;
    int turn_ = 0; // answers to those that were ended are not waited for
    bool wasStopped_ = false, hasFailed_ = false;
    bool isSent_ = false; // the command of its step
    QTimer pause_;
    QString text_;
};

} // namespace hermes::desktop
