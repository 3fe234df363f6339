#include "gui/desktop/model/Fleet.h"

#include "common/interface/InterfaceUrl.h"

namespace hermes::desktop {

Fleet::Fleet(QObject *parent)
    : QObject(parent) {
    changes_.setSingleShot(true);
    changes_.setInterval(10);
    connect(&changes_, &QTimer::timeout, this, &Fleet::changed);
}

Result<void> Fleet::add(const QString &address) {
    const bool hasPort = address.contains(':') && !address.endsWith(']');
    const auto url = InterfaceUrl::parse(hasPort ? address : address + ":1");
    if (!url)
        return url.error();
    if (url->scheme != "tcp" || url->host.isEmpty() || url->port == 0 || !url->path.isEmpty())
        return Error(
            ErrorCode::InvalidParams,
            tr("address \"%1\": expected HOST or HOST:PORT, with a port from 1 to 65535").arg(address));
    Robot &robot = robotAt(url->host);
    if (hasPort)
        robot.add(url->port, true);
    else
        robot.search();
    if (!addresses_.contains(address))
        addresses_.append(address);
    if (!robot_)
        choose(&robot);
    return {};
}

Robot &Fleet::robotAt(const QString &host) {
    for (const auto &robot : robots_)
        if (robot->host() == host)
            return *robot;
    robots_.push_back(std::make_unique<Robot>(host));
    Robot *const robot = robots_.back().get();
    connect(robot, &Robot::changed, &changes_, [this] {
        if (!changes_.isActive())
            changes_.start();
    });
    Q_EMIT changed();
    return *robot;
}

void Fleet::choose(Robot *robot) {
    if (robot_ == robot)
        return;
    robot_ = robot;
    Q_EMIT robotChosen(robot);
}

void Fleet::choose(DaemonLink *daemon) {
    if (daemon_ == daemon)
        return;
    daemon_ = daemon;
    for (const auto &robot : robots_)
        for (const DaemonLink *link : robot->daemons())
            if (link == daemon)
                choose(robot.get());
    Q_EMIT daemonChosen(daemon);
}

} // namespace hermes::desktop
