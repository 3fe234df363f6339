#pragma once

#include "gui/desktop/model/Events.h"
#include "gui/desktop/model/LogFeed.h"

namespace hermes::desktop {

/// Makes events of what the daemons of all robots tell: what is wrong with their health and their links for
/// as long as it is, warnings and errors of their logs, and who stops or releases a robot.
class EventWatch : public QObject {
    Q_OBJECT
public:
    /// Of a daemon, so many items of its health.
    static constexpr int mostItems = 50;

    EventWatch(Fleet &fleet, LogFeed &log, Events &events, QObject *parent = nullptr);

private:
    void watchAll();
    void watch(const Robot &robot, DaemonLink &daemon);
    void lookAtLink(const Robot &robot, const DaemonLink &daemon);
    void lookAtHealth(const Robot &robot, const DaemonLink &daemon);
    void onRecord(DaemonLink *daemon, const LogMessage &record, bool isPast);
    QString nameOf(const DaemonLink &daemon) const;

    Fleet &fleet_;
    Events &events_;
    QHash<const DaemonLink *, QStringList> ailing_; ///< the items of each that are not well
};

} // namespace hermes::desktop
