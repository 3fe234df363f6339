#pragma once

#include "gui/desktop/model/Fleet.h"
#include "gui/session/SessionPlayer.h"

namespace hermes::desktop {

/// Which daemons show what was recorded instead of what is, whoever began it: those of the chosen robot are
/// asked four times a second, those of the others now and then.
class ReplayWatch : public QObject {
    Q_OBJECT
public:
    explicit ReplayWatch(Fleet &fleet, QObject *parent = nullptr);
    /// What it plays was begun by this window.
    void setPlayer(SessionPlayer *player) { player_ = player; }

    /// Daemons of the chosen robot do.
    bool isReplaying() const { return !text_.isEmpty(); }
    /// Who of them replays what, and how far it is; empty: nobody.
    const QString &text() const { return text_; }
    /// Has all of them receive live again, whoever began it.
    void endAll() const;

    /// What it shows was begun by this window.
    bool isOwn(const Robot &robot) const;
    /// What becomes of the replays of all robots when the window is closed; empty: there are none.
    QString whenClosed() const;
    /// What this window began is live again soon.
    void endOwn() const;

Q_SIGNALS:
    /// Of the chosen robot.
    void changed();
    /// A robot was removed that may still show what this window began.
    void lost(const QString &title);

private:
    struct Source {
        bool isAsked = false; ///< and has not answered as yet
        QString replay;       ///< what is replayed; empty: nothing
    };

    void ask();
    void askAll(const Robot &robot);
    void take(DaemonLink *daemon, const QString &name, const Result<QJsonValue> &answer);
    void forget(QObject *daemon) { sources_.remove(daemon); }
    void tell();
    QString replayOf(const DaemonLink *daemon) const { return sources_.value(daemon).replay; }
    bool isReplaying(const Robot &robot) const;

    Fleet &fleet_;
    QPointer<SessionPlayer> player_;
    QTimer timer_;
    std::size_t turn_ = 0; ///< of the other robots
    QHash<const QObject *, Source> sources_;
    QString text_;
};

} // namespace hermes::desktop
