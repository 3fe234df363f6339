#pragma once

#include "gui/desktop/model/Fleet.h"

namespace hermes::desktop {

/// Whether daemons of the chosen robot show what was recorded instead of what is, whoever began it: they are
/// asked four times a second.
class ReplayWatch : public QObject {
    Q_OBJECT
public:
    explicit ReplayWatch(Fleet &fleet, QObject *parent = nullptr);

    bool isReplaying() const { return !replays_.empty(); }
    /// Who replays what, and how far it is; empty: nobody.
    QString text() const;
    /// Has all of them receive live again.
    void endAll() const;

Q_SIGNALS:
    void changed();

private:
    void ask();
    void take(const QString &address, const QString &name, const Result<QJsonValue> &answer);

    Fleet &fleet_;
    QTimer timer_;
    QSet<QString> asked_;                ///< the addresses of those that have not answered as yet
    std::map<QString, QString> replays_; ///< what, by the address of a daemon of the chosen robot
};

} // namespace hermes::desktop
