#include "common/Project.h"
#include "gui/desktop/model/Fleet.h"
#include "gui/desktop/widgets/ForeignText.h"
#include "protocol/wire/Fields.h"

namespace hermes::desktop {
namespace {

constexpr int longestName = 30;
constexpr std::size_t mostDaemons = 100; // of one robot, as far as its supervisor names them

} // namespace

Robot::Robot(const QString &host, QObject *parent)
    : QObject(parent)
    , host_(host) {}

QString Robot::name() const {
    return name_.isEmpty() ? host_ : name_;
}

std::vector<DaemonLink *> Robot::daemons() const {
    std::vector<DaemonLink *> shown;
    for (const auto &[port, entry] : entries_)
        if (entry.isExpected || entry.link->isKnown())
            shown.push_back(entry.link.get());
    return shown;
}

DaemonLink *Robot::withMethod(const QString &method) const {
    const std::vector<DaemonLink *> all = allWithMethod(method);
    return all.empty() ? nullptr : all.front();
}

std::vector<DaemonLink *> Robot::allWithMethod(const QString &method) const {
    std::vector<DaemonLink *> found;
    for (const auto &[port, entry] : entries_)
        if (entry.link->isConnected() && entry.link->hasMethod(method))
            found.push_back(entry.link.get());
    return found;
}

DaemonLink *Robot::withTopic(const QString &topic) const {
    for (const auto &[port, entry] : entries_)
        if (entry.link->isConnected() && entry.link->hasTopic(topic))
            return entry.link.get();
    return nullptr;
}

DaemonLink *Robot::withName(const QString &name) const {
    for (const auto &[port, entry] : entries_)
        if (entry.link->isKnown() && entry.link->name() == name)
            return entry.link.get();
    return nullptr;
}

DaemonLink *Robot::supervisor() const {
    return withMethod("process.list");
}

const ProcessStatus *Robot::process(const DaemonLink &daemon) const {
    for (const ProcessStatus &process : processes_)
        if (process.entry.port == daemon.address().section(':', -1).toInt())
            return &process;
    return nullptr;
}

void Robot::search() {
    for (const QString &name : daemonNames())
        add(defaultPort(name), false);
}

DaemonLink *Robot::add(quint16 port, bool isExpected) {
    const std::size_t before = entries_.size();
    DaemonLink *const link = found(port, isExpected);
    if (entries_.size() > before)
        Q_EMIT changed();
    return link;
}

DaemonLink *Robot::found(quint16 port, bool isExpected) {
    const auto known = entries_.find(port);
    if (known != entries_.end()) {
        known->second.isExpected = known->second.isExpected || isExpected;
        return known->second.link.get();
    }
    const QString address = (host_.contains(':') ? "[%1]:%2" : QString("%1:%2")).arg(host_).arg(port);
    Entry &entry = entries_[port];
    entry = {std::make_unique<DaemonLink>(address), isExpected};
    DaemonLink *const link = entry.link.get();
    connect(link, &DaemonLink::changed, this, &Robot::changed);
    connect(link, &DaemonLink::ready, this, [this, link] {
        followSupervisor(link);
        Q_EMIT changed();
        Q_EMIT capabilitiesChanged();
    });
    connect(&link->client(), &Client::disconnected, this, [this, link] {
        if (link->isKnown())
            Q_EMIT capabilitiesChanged();
    });
    return link;
}

void Robot::remove(DaemonLink *daemon) {
    for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
        if (entry->second.link.get() != daemon)
            continue;
        entry->second.link.release()->deleteLater();
        entries_.erase(entry);
        Q_EMIT changed();
        Q_EMIT capabilitiesChanged();
        return;
    }
}

void Robot::followSupervisor(DaemonLink *link) {
    if (followed_ == link || !link->hasMethod("process.list"))
        return;
    followed_ = link;
    search();
    link->subscribe("processes", {{"max_rate_hz", 10}},
                    [this](const TopicUpdate &update) { takeProcesses(update.data); });
}

void Robot::takeProcesses(WireView data) {
    ReadReport report;
    auto told = readMessage<ProcessesMessage>(data, report);
    if (told) {
        name_ = shortLine(told->robot, longestName);
        processes_ = std::move(told->processes);
        const std::size_t all = processes_.size();
        processes_.resize(std::min(all, mostDaemons));
        for (const ProcessStatus &process : processes_)
            if (process.entry.port > 0 && entries_.size() < mostDaemons)
                found(process.entry.port, true);
        problem_ = all > mostDaemons
                       ? tr("%1 more processes of the supervisor are not shown").arg(all - mostDaemons)
                       : QString();
    } else {
        problem_ = tr("The supervisor's processes: %1").arg(report.text());
    }
    Q_EMIT changed();
}

} // namespace hermes::desktop
