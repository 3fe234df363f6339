#include "common/daemon/RobotDaemons.h"

#include "common/Log.h"
#include "common/Time.h"
#include "common/client/DaemonAddress.h"
#include "protocol/wire/Fields.h"

#include <QCoreApplication>
#include <QJsonArray>
#include <QRegularExpression>
#include <QSysInfo>
#include <algorithm>

namespace hermes {
namespace {

constexpr double timeout_s = 5;         // with who is connected and has not told who it is
constexpr std::size_t maxDaemons = 100; // a supervisor may name what it likes

QSet<QString> commandsOf(const QJsonValue &description) {
    QSet<QString> commands;
    for (const QJsonValue &method : description["methods"].toArray()) {
        const QString name = method["name"].toString();
        commands.insert(name);
        for (const QJsonValue &param : method["params"].toArray())
            commands.insert(name + ' ' + param["name"].toString());
    }
    return commands;
}

bool isThisProgram(const QJsonObject &info) {
    return qint64(info["pid"].toDouble()) == QCoreApplication::applicationPid() &&
           info["host"].toString() == QSysInfo::machineHostName();
}

} // namespace

void RobotDaemons::follow(const QStringList &addresses) {
    for (auto daemon = daemons_.begin(); daemon != daemons_.end();) {
        if (addresses.contains(daemon->first) || daemon->second->isNamed) {
            ++daemon;
            continue;
        }
        daemon->second->client->close(); // what waits for it ends
        lose(*daemon->second);
        daemon = daemons_.erase(daemon);
    }
    for (const QString &address : addresses)
        add(address);
}

void RobotDaemons::add(const QString &address, bool isNamed) {
    if (daemons_.count(address) != 0 || daemons_.size() >= maxDaemons)
        return;
    Daemon &daemon = *daemons_.emplace(address, std::make_unique<Daemon>()).first->second;
    daemon.isNamed = isNamed;
    daemon.address = address;
    daemon.client = std::make_unique<Client>();
    daemon.client->prefer("cbor");
    connect(daemon.client.get(), &Client::connected, this, [this, &daemon] {
        daemon.connected = monotonicNow();
        ask(daemon);
    });
    connect(daemon.client.get(), &Client::disconnected, this, [this, &daemon] { lose(daemon); });
    connect(daemon.client.get(), &Client::subscriptionFailed, this,
            [this, &daemon](int, const RpcError &error) {
                Q_EMIT missed(QString("%1: a topic is not recorded: %2").arg(daemon.name, error.message));
            });
    if (const Result<void> begun = daemon.client->connectTo(asOwner(address)); !begun)
        logWarning("daemons", address + ": " + begun.error().message);
}

void RobotDaemons::ask(Daemon &daemon) {
    others_.remove(daemon.address);
    daemon.client->call("daemon.info", QJsonObject(), [this, &daemon](const Result<QJsonValue> &info) {
        if (!info)
            return; // askAgain() does
        if (!isOurs(info->toObject())) {
            others_.insert(daemon.address);
            return;
        }
        daemon.client->callForMuch(
            "rpc.discover", QJsonObject(),
            [this, &daemon, told = info->toObject()](const Result<QJsonValue> &description) {
                if (description && daemon.client->isConnected())
                    take(daemon, told, *description);
            });
    });
}

void RobotDaemons::askAgain() {
    for (const auto &[address, daemon] : daemons_) {
        if (daemon->client->isConnected() && !daemon->isKnown && !others_.contains(address))
            ask(*daemon);
        if (daemon->isKnown)
            followSupervisor(*daemon); // it may start others than before
        const Client::Rejected &rejected = daemon->client->rejected();
        if (daemon->unreadable != std::exchange(daemon->unreadable, rejected.unreadable))
            Q_EMIT missed(QString("%1: messages that cannot be read: %2").arg(daemon->name, rejected.last));
    }
}

void RobotDaemons::forgetSilent() {
    for (const auto &entry : daemons_)
        if (!entry.second->isKnown)
            entry.second->name.clear();
}

bool RobotDaemons::isOurs(const QJsonObject &info) const {
    const QString robot = info["robot"].toObject()["id"].toString();
    return robot_.isEmpty() || robot.isEmpty() || robot == robot_;
}

void RobotDaemons::take(Daemon &daemon, const QJsonObject &info, const QJsonValue &description) {
    if (daemon.isKnown) // it was asked twice
        return;
    const auto isSame = [&](const auto &other) { // by another address
        return other.second->isKnown && other.second->info["pid"] == info["pid"] &&
               other.second->info["host"] == info["host"] && other.second->info["started"] == info["started"];
    };
    if (std::any_of(daemons_.begin(), daemons_.end(), isSame)) {
        others_.insert(daemon.address);
        return;
    }
    static const QRegularExpression name("^[A-Za-z0-9][A-Za-z0-9._-]{0,63}$");
    if (!name.match(info["name"].toString()).hasMatch()) { // it becomes part of paths
        others_.insert(daemon.address);
        return logWarning("daemons", daemon.address + ": it has no name that can be used");
    }
    daemon.name = info["name"].toString();
    Daemon *const other = find(daemon.name);
    if ((other && other != &daemon) || (daemon.name == ownName_ && !isThisProgram(info)))
        daemon.name += '@' + daemon.address.section("//", -1);
    daemon.info = info;
    daemon.commands = commandsOf(description);
    daemon.methods = description["methods"].toArray();
    daemon.topics.clear();
    for (const QJsonValue &topic : description["x-topics"].toArray()) {
        ReadReport report;
        if (const auto read = readMessage<TopicDescription>(WireValue(topic), report))
            daemon.topics.push_back(*read);
        else
            Q_EMIT missed(daemon.name + ": a topic cannot be read: " + report.text().left(200));
    }
    daemon.isKnown = true;
    followSupervisor(daemon);
    Q_EMIT came(&daemon);
}

void RobotDaemons::followSupervisor(Daemon &supervisor) {
    if (!supervisor.commands.contains("process.list"))
        return;
    const QString host = supervisor.address.section(':', 0, -2);
    supervisor.client->call("process.list", QJsonObject(), [this, host](const Result<QJsonValue> &processes) {
        ReadReport report;
        const auto read = processes ? readMessage<ProcessesMessage>(WireValue(*processes), report)
                                    : std::optional<ProcessesMessage>();
        for (const ProcessStatus &process : read.value_or(ProcessesMessage()).processes)
            if (process.entry.port != 0)
                add(host + ':' + QString::number(process.entry.port), true);
    });
}

void RobotDaemons::lose(Daemon &daemon) {
    others_.remove(daemon.address);
    if (std::exchange(daemon.isKnown, false))
        Q_EMIT went(&daemon);
}

std::vector<const RobotDaemons::Daemon *> RobotDaemons::undescribed() const {
    std::vector<const Daemon *> found;
    for (const auto &[address, daemon] : daemons_)
        if (!daemon->isKnown && daemon->client->isConnected() && !others_.contains(address) &&
            monotonicNow() - daemon->connected > timeout_s)
            found.push_back(daemon.get());
    return found;
}

RobotDaemons::Daemon *RobotDaemons::find(const QString &name) const {
    for (const auto &entry : daemons_)
        if (entry.second->isKnown && entry.second->name == name)
            return entry.second.get();
    return nullptr;
}

QStringList RobotDaemons::silent() const {
    QStringList names;
    for (const auto &entry : daemons_)
        if (!entry.second->isKnown && !entry.second->name.isEmpty())
            names.append(entry.second->name);
    return names;
}

} // namespace hermes
