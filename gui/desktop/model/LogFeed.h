#pragma once

#include "gui/desktop/model/Fleet.h"

#include <QSet>

namespace hermes::desktop {

/// What all daemons of all robots log, in one stream.
class LogFeed : public QObject {
    Q_OBJECT
public:
    /// Of a daemon's, before it is connected.
    static constexpr int lastRecords = 100;
    /// When a record was logged: before the daemon was followed, while its link was away, or now.
    enum class When { Before, Missed, Now };

    explicit LogFeed(Fleet &fleet, QObject *parent = nullptr);

    /// With that of its robot, where there are several.
    QString nameOf(const DaemonLink &daemon) const { return fleet_.titleOf(daemon); }

Q_SIGNALS:
    /// record: one that cannot be read comes as a warning that says why, with a negative stamp.
    void recorded(hermes::desktop::DaemonLink *daemon, const hermes::LogMessage &record,
                  hermes::desktop::LogFeed::When when);

private:
    void followAll();
    void follow(DaemonLink *daemon);
    void readLast(DaemonLink *daemon);
    /// after: those up to this stamp are known.
    void take(DaemonLink *daemon, WireView record, When when, double after = -1);

    struct Followed {
        double latest = -1;  ///< stamp of the latest record; -1: none
        QSet<double> stamps; ///< of those that came since it was connected
        Subscription log;
    };

    Fleet &fleet_;
    QHash<const DaemonLink *, Followed> followed_;
};

} // namespace hermes::desktop
