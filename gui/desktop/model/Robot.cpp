#include "gui/desktop/model/Robot.h"

#include "gui/desktop/widgets/ForeignText.h"
#include "protocol/wire/Fields.h"

#include <algorithm>

namespace hermes::desktop {
namespace {

constexpr std::size_t maxProcesses = 100; // of one supervisor

} // namespace

Robot::Robot(const QString &host, const QString &address, DaemonLink *supervisor, QObject *parent)
    : QObject(parent)
    , host_(host)
    , address_(address)
    , isSupervised_(supervisor)
    , supervisor_(supervisor) {
    if (supervisor)
        handle_ = supervisor->subscribe("processes", {{"max_rate_hz", 10}},
                                        [this](const TopicUpdate &update) { takeProcesses(update.data); });
}

Robot::~Robot() {
    if (supervisor_)
        supervisor_->unsubscribe(handle_);
}

QString Robot::name() const {
    return !givenName_.isEmpty()  ? givenName_
           : !toldName_.isEmpty() ? toldName_
           : isSupervised_        ? host_
                                  : address_;
}

void Robot::setGivenName(const QString &name) {
    givenName_ = name;
    Q_EMIT changed();
}

std::vector<DaemonLink *> Robot::daemons() const {
    std::vector<DaemonLink *> all;
    for (const auto &[port, daemon] : daemons_)
        all.push_back(daemon);
    return all;
}

bool Robot::has(const DaemonLink *daemon) const {
    const auto found = daemon ? daemons_.find(daemon->port()) : daemons_.end();
    return found != daemons_.end() && found->second == daemon;
}

DaemonLink *Robot::withMethod(const QString &method) const {
    const std::vector<DaemonLink *> all = allWithMethod(method);
    return all.empty() ? nullptr : all.front();
}

std::vector<DaemonLink *> Robot::allWithMethod(const QString &method) const {
    std::vector<DaemonLink *> found;
    for (const auto &[port, daemon] : daemons_)
        if (daemon->isConnected() && daemon->hasMethod(method))
            found.push_back(daemon);
    return found;
}

DaemonLink *Robot::withTopic(const QString &topic) const {
    for (const auto &[port, daemon] : daemons_)
        if (daemon->isConnected() && daemon->hasTopic(topic))
            return daemon;
    return nullptr;
}

DaemonLink *Robot::withName(const QString &name) const {
    for (const auto &[port, daemon] : daemons_)
        if (daemon->isKnown() && daemon->name() == name)
            return daemon;
    return nullptr;
}

DaemonLink *Robot::supervisor() const {
    return supervisor_ && supervisor_->isConnected() && supervisor_->hasMethod("process.list")
               ? supervisor_.data()
               : nullptr;
}

const ProcessStatus *Robot::process(const DaemonLink &daemon) const {
    if (has(&daemon))
        for (const ProcessStatus &process : processes_)
            if (process.entry.port == daemon.port())
                return &process;
    return nullptr;
}

QString Robot::problem() const {
    QStringList lines = conflicts_;
    if (!problem_.isEmpty())
        lines.prepend(problem_);
    return lines.join('\n');
}

void Robot::take(DaemonLink *daemon) {
    daemons_[daemon->port()] = daemon;
    connect(daemon, &DaemonLink::changed, this, &Robot::changed);
    connect(daemon, &DaemonLink::ready, this, [this] {
        Q_EMIT changed();
        Q_EMIT capabilitiesChanged();
    });
    connect(&daemon->client(), &Client::disconnected, this, [this, daemon] {
        if (daemon->isKnown())
            Q_EMIT capabilitiesChanged();
    });
    nameDaemons();
}

void Robot::release(DaemonLink *daemon) {
    daemons_.erase(daemon->port());
    daemon->disconnect(this);
    daemon->client().disconnect(this);
}

void Robot::setConflicts(const QStringList &conflicts) {
    if (conflicts_ == conflicts)
        return;
    conflicts_ = conflicts;
    Q_EMIT changed();
}

/// Those that have not said their names.
void Robot::nameDaemons() {
    for (const auto &[port, daemon] : daemons_)
        if (const ProcessStatus *const process = this->process(*daemon))
            daemon->setSupervisedName(process->entry.name);
}

void Robot::takeProcesses(WireView data) {
    ReadReport report;
    auto told = readMessage<ProcessesMessage>(data, report);
    if (!told) {
        problem_ = tr("The supervisor's processes: %1").arg(report.text());
        return Q_EMIT changed();
    }
    const QString before = std::exchange(toldName_, shortLine(told->robot, longestName));
    processes_ = std::move(told->processes);
    const std::size_t all = processes_.size();
    processes_.resize(std::min(all, maxProcesses));
    problem_ = all > maxProcesses
                   ? tr("%1 more processes of the supervisor are not shown").arg(all - maxProcesses)
                   : QString();
    std::set<quint16> named;
    for (const ProcessStatus &process : processes_)
        if (process.entry.port > 0 && process.entry.port != supervisor_->port())
            named.insert(process.entry.port);
    if (std::exchange(named_, named) != named || before != toldName_)
        Q_EMIT namedChanged();
    nameDaemons();
    Q_EMIT changed();
}

} // namespace hermes::desktop
