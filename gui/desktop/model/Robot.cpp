#include "gui/desktop/model/Robot.h"

#include "gui/desktop/widgets/ForeignText.h"
#include "protocol/wire/Fields.h"

#include <algorithm>

namespace hermes::desktop {
namespace {

constexpr std::size_t maxProcesses = 100; // of one supervisor

} // namespace

Robot::Robot(const QString &id, QObject *parent)
    : QObject(parent)
    , id_(id) {}

QString Robot::address() const {
    QStringList places;
    for (const auto &[link, supervisor] : supervisors_)
        places.append(link->address());
    if (places.isEmpty())
        for (const auto &[place, daemon] : daemons_)
            places.append(daemon->host());
    places.removeDuplicates();
    places.sort();
    return places.join(", ");
}

void Robot::setGivenName(const QString &name) {
    givenName_ = name;
    Q_EMIT changed();
}

std::vector<DaemonLink *> Robot::daemons() const {
    std::vector<DaemonLink *> all;
    for (const auto &[place, daemon] : daemons_)
        all.push_back(daemon);
    return all;
}

bool Robot::has(const DaemonLink *daemon) const {
    const auto found = daemon ? daemons_.find({daemon->port(), daemon->host()}) : daemons_.end();
    return found != daemons_.end() && found->second == daemon;
}

std::vector<DaemonLink *> Robot::allWithMethod(const QString &method) const {
    std::vector<DaemonLink *> found;
    for (const auto &[place, daemon] : daemons_)
        if (daemon->isConnected() && daemon->hasMethod(method))
            found.push_back(daemon);
    return found;
}

Robot::Found Robot::find(const DaemonLink &daemon) const {
    if (has(&daemon))
        for (const auto &[link, supervisor] : supervisors_)
            if (link->host() == daemon.host())
                for (const ProcessStatus &process : supervisor.processes)
                    if (process.entry.port == daemon.port())
                        return {link, &process};
    return {};
}

DaemonLink *Robot::supervisorOf(const DaemonLink &daemon) const {
    DaemonLink *const found = find(daemon).first;
    return found && found->isConnected() && found->hasMethod("process.list") ? found : nullptr;
}

QString Robot::problem() const {
    QStringList lines = conflicts_;
    for (const auto &[link, supervisor] : supervisors_)
        if (!supervisor.problem.isEmpty())
            lines.prepend(supervisor.problem);
    return lines.join('\n');
}

void Robot::take(DaemonLink *daemon) {
    daemons_[{daemon->port(), daemon->host()}] = daemon;
    if (toldName_.isEmpty())
        toldName_ = shortLine(daemon->robotName(), longestName).trimmed();
    connect(daemon, &DaemonLink::changed, this, &Robot::changed);
    connect(daemon, &DaemonLink::ready, this, [this, daemon] {
        watch(daemon);
        Q_EMIT changed();
        Q_EMIT capabilitiesChanged();
    });
    connect(&daemon->client(), &Client::disconnected, this, [this, daemon] {
        if (daemon->isKnown())
            Q_EMIT capabilitiesChanged();
    });
    watch(daemon);
    nameDaemons();
}

void Robot::release(DaemonLink *daemon) {
    daemons_.erase({daemon->port(), daemon->host()});
    daemon->disconnect(this);
    daemon->client().disconnect(this);
    if (supervisors_.erase(daemon) > 0)
        findNamed();
}

/// A supervisor.
void Robot::watch(DaemonLink *daemon) {
    if (!daemon->hasMethod("process.list") || supervisors_.count(daemon) > 0)
        return;
    supervisors_[daemon].subscription =
        daemon->subscribe("processes", {{"max_rate_hz", 10}},
                          [this, daemon](const TopicUpdate &update) { takeProcesses(daemon, update.data); });
}

void Robot::setConflicts(const QStringList &conflicts) {
    if (conflicts_ == conflicts)
        return;
    conflicts_ = conflicts;
    Q_EMIT changed();
}

/// Those that have not said their names.
void Robot::nameDaemons() {
    for (const auto &[place, daemon] : daemons_)
        if (const ProcessStatus *const process = this->process(*daemon))
            daemon->setSupervisedName(process->entry.name);
}

void Robot::takeProcesses(DaemonLink *link, WireView data) {
    const auto found = supervisors_.find(link);
    if (found == supervisors_.end())
        return;
    Supervisor &supervisor = found->second;
    ReadReport report;
    auto told = readMessage<ProcessesMessage>(data, report);
    if (!told) {
        supervisor.problem = tr("The supervisor's processes: %1").arg(report.text());
        return Q_EMIT changed();
    }
    if (const QString name = shortLine(told->robot, longestName); !name.isEmpty())
        toldName_ = name;
    supervisor.processes = std::move(told->processes);
    const std::size_t all = supervisor.processes.size();
    supervisor.processes.resize(std::min(all, maxProcesses));
    supervisor.problem = all > maxProcesses
                             ? tr("%1 more processes of the supervisor are not shown").arg(all - maxProcesses)
                             : QString();
    if (findNamed())
        Q_EMIT namedChanged();
    nameDaemons();
    Q_EMIT changed();
}

/// Whether it is not as before.
bool Robot::findNamed() {
    std::set<Place> named;
    for (const auto &[link, supervisor] : supervisors_)
        for (const ProcessStatus &process : supervisor.processes)
            if (process.entry.port > 0 && process.entry.port != link->port())
                named.insert({link->host(), process.entry.port});
    return std::exchange(named_, named) != named;
}

} // namespace hermes::desktop
