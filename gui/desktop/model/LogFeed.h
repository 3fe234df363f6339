#pragma once

#include "gui/desktop/model/Fleet.h"

#include <QSet>

namespace hermes::desktop {

/// What all daemons of all robots log, in one stream.
class LogFeed : public QObject {
    Q_OBJECT
public:
    /// Of a daemon's, before it is followed.
    static constexpr int lastRecords = 100;

    explicit LogFeed(Fleet &fleet, QObject *parent = nullptr);

    /// With that of its robot, where there are several.
    QString nameOf(const DaemonLink &daemon) const { return fleet_.titleOf(daemon); }

Q_SIGNALS:
    /// record: one that cannot be read comes as a warning that says why, with a negative stamp. isPast: it
    /// was logged before the daemon was followed.
    void recorded(hermes::desktop::DaemonLink *daemon, const hermes::LogMessage &record, bool isPast);

private:
    void followAll();
    void follow(DaemonLink *daemon);
    void take(DaemonLink *daemon, WireView record, bool isPast);

    Fleet &fleet_;
    QSet<const DaemonLink *> followed_;
};

} // namespace hermes::desktop
