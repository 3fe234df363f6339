#pragma once

#include "gui/desktop/drive/DriveControl.h"
#include "gui/desktop/model/Events.h"
#include "gui/desktop/model/LogFeed.h"

namespace hermes::desktop {

/// Makes events of what the daemons of all robots tell: what is wrong with their health and their links for
/// as long as it is, warnings and errors of their logs, and who stops or releases a robot. Makes a note of
/// each other client that takes the control of the chosen one.
class EventWatch : public QObject {
    Q_OBJECT
public:
    /// Of a daemon, so many items of its health.
    static constexpr int maxItems = 50;
    /// A daemon that has just begun is not well yet: until then its health makes no events.
    static constexpr std::chrono::seconds settling{3};

    EventWatch(Fleet &fleet, LogFeed &log, const DriveControl &drive, Events &events,
               QObject *parent = nullptr);

private:
    struct Watched {
        QStringList ailing;      ///< the keys of what is not well
        QElapsedTimer connected; ///< since the connection was made
        QString name;            ///< under which it was told of
    };

    void watchAll();
    void watch(const Robot &robot, DaemonLink &daemon);
    void lookAtLink(const Robot &robot, const DaemonLink &daemon);
    void lookAtHealth(const DaemonLink &daemon);
    void lookAtControl(const DriveControl &drive);
    void onRecord(DaemonLink *daemon, const LogMessage &record, LogFeed::When when);
    QString nameOf(const DaemonLink &daemon) const;

    Fleet &fleet_;
    Events &events_;
    QHash<const DaemonLink *, Watched> watched_;
    const Robot *robot_ = nullptr; ///< whose control the next is
    QString holder_;
};

} // namespace hermes::desktop
