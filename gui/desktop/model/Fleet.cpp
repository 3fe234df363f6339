#include "gui/desktop/model/Fleet.h"

#include "common/Project.h"
#include "common/interface/InterfaceUrl.h"
#include "gui/desktop/widgets/ForeignText.h"

#include <QHostAddress>
#include <QRegularExpression>
#include <algorithm>

namespace hermes::desktop {
Fleet::Fleet(QObject *parent)
    : QObject(parent) {
    changes_.setSingleShot(true);
    changes_.setInterval(10);
    connect(&changes_, &QTimer::timeout, this, [this] {
        tellConflicts();
        Q_EMIT changed();
    });
}

Fleet::~Fleet() = default;

Result<void> Fleet::add(const QString &address) {
    const bool hasPort = address.contains(':') && !address.endsWith(']');
    const auto url = InterfaceUrl::parse(hasPort ? address : address + ":1");
    if (!url)
        return url.error();
    if (url->scheme != "tcp" || url->host.isEmpty() || url->port == 0 || !url->path.isEmpty())
        return Error(ErrorCode::InvalidParams, tr("address \"%1\": expected a name or an address, as "
                                                  "192.168.1.20, or with a port, as 192.168.1.20:7450")
                                                   .arg(address));
    static const QRegularExpression numbers(R"(^(?:tcp://)?([0-9.]+)(?::|$))"),
        four(R"(^\d{1,3}(\.\d{1,3}){3}$)");
    if (const QString typed = numbers.match(address).captured(1);
        !typed.isEmpty() && (!four.match(typed).hasMatch() || QHostAddress(typed).isNull()))
        return Error(ErrorCode::InvalidParams,
                     tr("address \"%1\": expected four numbers from 0 to 255").arg(address));
    const QString name = url->host == "localhost" ? QString("127.0.0.1") : url->host;
    const QString host = name.contains(':') ? '[' + name + ']' : name;
    const QString known = hasPort ? QString("%1:%2").arg(host).arg(url->port) : host;
    if (addresses_.contains(known))
        return {};
    addresses_.append(known);
    if (!robot_ && preferred_.isEmpty())
        preferred_ = known;
    if (hasPort) {
        entryAt({host, url->port}).isAdded = true;
    } else {
        setAt(host, host);
        for (const QString &daemon : daemonNames())
            entryAt({host, defaultPort(daemon)}).isSought = true;
    }
    distribute();
    return {};
}

Fleet::Entry &Fleet::entryAt(const Place &place) {
    Entry &entry = entries_[place];
    if (entry.link)
        return entry;
    entry.link = std::make_unique<DaemonLink>(QString("%1:%2").arg(place.first).arg(place.second));
    connect(entry.link.get(), &DaemonLink::ready, this, [this, place] { onReady(place); });
    connect(entry.link.get(), &DaemonLink::changed, this, [this, place] { onChanged(place); });
    return entry;
}

void Fleet::onReady(const Place &place) {
    Entry &entry = entries_.at(place);
    if (entry.led || !entry.link->hasMethod("process.list"))
        return touch();
    entry.led = makeRobot(place.first, entry.link->address(), entry.link.get());
    connect(entry.led, &Robot::namedChanged, this, [this] { distribute(); });
    distribute();
}

void Fleet::onChanged(const Place &place) {
    const Entry &entry = entries_.at(place);
    if (!entry.namedBy && entry.isOfHost() != bool(entry.robot))
        distribute();
}

Robot *Fleet::makeRobot(const QString &host, const QString &address, DaemonLink *supervisor) {
    robots_.push_back(std::make_unique<Robot>(host, address, supervisor));
    Robot *const robot = robots_.back().get();
    connect(robot, &Robot::changed, this, &Fleet::touch);
    robot->setGivenName(names_.value(robot->address()));
    return robot;
}

DaemonLink *Fleet::daemonAt(const QString &address) const {
    const auto entry = entries_.find({address.section(':', 0, -2), address.section(':', -1).toUShort()});
    return entry == entries_.end() ? nullptr : entry->second.link.get();
}

Robot *Fleet::robotOf(const DaemonLink *daemon) const {
    if (!daemon)
        return nullptr;
    const auto entry = entries_.find({daemon->host(), daemon->port()});
    return entry != entries_.end() && entry->second.link.get() == daemon ? entry->second.robot : nullptr;
}

Robot *Fleet::robotAt(const QString &address) const {
    for (const auto &robot : robots_)
        if (robot->address() == address)
            return robot.get();
    return nullptr;
}

QString Fleet::titleOf(const Robot &robot) const {
    if (namesakes_.isEmpty())
        for (const auto &other : robots_)
            ++namesakes_[other->name()];
    return namesakes_.value(robot.name()) > 1 ? tr("%1 (%2)").arg(robot.name(), robot.address())
                                              : robot.name();
}

QString Fleet::titleOf(const DaemonLink &daemon) const {
    const Robot *const robot = robotOf(&daemon);
    return robots_.size() > 1 && robot ? tr("%1 of %2").arg(daemon.name(), titleOf(*robot)) : daemon.name();
}

void Fleet::setNames(const QMap<QString, QString> &names) {
    names_ = names;
    for (const auto &robot : robots_)
        robot->setGivenName(names_.value(robot->address()));
}

void Fleet::rename(Robot &robot, const QString &name) {
    const QString given = shortLine(name.trimmed(), Robot::longestName);
    if (given.isEmpty())
        names_.remove(robot.address());
    else
        names_[robot.address()] = given;
    robot.setGivenName(given);
}

void Fleet::prefer(const QString &address) {
    const auto hostIn = [](const QString &one) {
        return one.section('#', 0, 0).section(QRegularExpression(":\\d+$"), 0, 0);
    };
    const auto leadsThere = [&](const QString &added) { return hostIn(added) == hostIn(address); };
    if (isMeant_ || address.isEmpty() ||
        (!addresses_.isEmpty() && std::none_of(addresses_.begin(), addresses_.end(), leadsThere)))
        return;
    preferred_ = address;
    distribute();
}

QString Fleet::chosenAddress() const {
    return !preferred_.isEmpty() ? preferred_ : robot_ ? robot_->address() : QString();
}

void Fleet::choose(Robot *robot) {
    keepChoice();
    if (robot_ != robot)
        setChosen(robot, lastDaemonOf(robot));
}

void Fleet::choose(DaemonLink *daemon) {
    keepChoice();
    Robot *const robot = robotOf(daemon);
    setChosen(robot ? robot : robot_, daemon);
}

void Fleet::goAlong(Robot *robot) {
    if (preferred_.isEmpty())
        setChosen(robot, robotOf(daemon_) == robot ? daemon_.data() : lastDaemonOf(robot));
}

void Fleet::keepChoice() {
    isMeant_ = isMeant_ || robot_;
    if (isMeant_)
        preferred_.clear();
}

DaemonLink *Fleet::lastDaemonOf(const Robot *robot) const {
    const auto last = lastDaemons_.find(robot);
    return last != lastDaemons_.end() && robot && robot->has(last->second) ? last->second.data() : nullptr;
}

void Fleet::setChosen(Robot *robot, DaemonLink *daemon) {
    const bool isOther = std::exchange(robot_, robot) != robot;
    const bool isOtherDaemon = daemon_ != daemon;
    daemon_ = daemon;
    lastDaemons_[robot] = daemon;
    if (isOther)
        Q_EMIT robotChosen(robot);
    if (isOtherDaemon)
        Q_EMIT daemonChosen(daemon);
}

void Fleet::touch() {
    namesakes_.clear();
    if (!changes_.isActive())
        changes_.start();
}

} // namespace hermes::desktop
