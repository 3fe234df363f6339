// How the set-up looks for what is plugged in, also on lines that processes of the supervisor use.
#include "common/Log.h"
#include "common/interface/InterfaceUrl.h"
#include "common/settings/DottedPath.h"
#include "daemons/supervisor/PortUsers.h"
#include "daemons/supervisor/Setup.h"
#include "protocol/wire/Fields.h"

#include <QFileInfo>
#include <QHostAddress>
#include <QTimer>
#include <algorithm>

namespace hermes::supervisor {
namespace {

constexpr std::chrono::milliseconds look{20};  // whether a process has ended
constexpr std::chrono::seconds endsWithin{10}; // SIGKILL comes after 5 s

/// Daemons that open serial lines or receive from lidars as soon as they can.
const QStringList deviceDaemons{"hermes-motorcontrol", "hermes-scanner", "hermes-seriallogger",
                                "hermes-velodynelogger"};

} // namespace

Command Setup::findCommand() {
    return Command(
               "setup.find",
               "Looks for a few seconds what is plugged in: serial lines, and lidars that send packets. "
               "It listens; what is silent is asked for the version of a RoboClaw, which moves nothing, "
               "where the line is known as a motor controller's (by USB or by the settings). Where ask is "
               "true all others are asked, too, also whether they are laser scanners. What another program "
               "uses is left alone")
        .needs(Role::Engineer)
        .param(Field::boolean("ask", "Ask all silent lines: a motor controller that is no RoboClaw in packet "
                                     "serial mode may take the bytes for speeds; wheels off the ground")
                   .byDefault(false))
        .param(Field::boolean("release", "Processes of the supervisor that use serial lines or receive "
                                         "packets of lidars are ended first, and started again afterwards")
                   .byDefault(false))
        .gives<Findings>()
        .asyncHandler([this](const Call &call, const Reply &reply) {
            if (isWriting_ || isSearching_)
                return reply.error(busy(isWriting_ ? "a change" : "a search"));
            isSearching_ = true;
            searchWhenStopped(call.flag("release") ? release() : Stopped(), QDeadlineTimer(endsWithin),
                              call.flag("ask"), reply);
        });
}

DeviceSearch::Options Setup::searchOptions(bool ask) const {
    DeviceSearch::Options options;
    for (const QJsonValue &port : settings_.value("setup.ports").toArray())
        options.ports.append(port.toString());
    options.ask = ask;
    options.lidarPort = quint16(settings_.integer("setup.lidar_port"));
    options.positionPort = quint16(settings_.integer("setup.position_port"));
    const QJsonObject current = files().readable();
    // Also what the system does not list, as lines of the simulator.
    const auto add = [&options](const QJsonValue &text, QStringList *others) {
        const auto url = InterfaceUrl::parse(text.toString());
        if (!url || url->scheme != "serial" || !QFileInfo::exists(url->path))
            return;
        options.ports.append(url->path);
        if (others)
            others->append(url->path);
    };
    const QString kind = valueAt(current, "motorcontrol.controllers.kind").toString("roboclaw");
    for (const QJsonValue &controller : valueAt(current, "motorcontrol.controllers").toObject())
        add(controller["url"],
            kind == "roboclaw" ? &options.controllers : nullptr); // others are asked as such, if at all
    for (const QJsonValue &port : valueAt(current, "seriallogger.ports").toArray())
        add(port["url"], nullptr);
    add(valueAt(current, "scanner.scanner.url"), nullptr);
    return options;
}

Setup::Stopped Setup::release() {
    const QList<quint16> udp{quint16(settings_.integer("setup.lidar_port")),
                             quint16(settings_.integer("setup.position_port"))};
    Stopped stopped;
    for (SupervisedProcess *const process : processes_()) {
        const auto state = process->state();
        if (state == SupervisedProcess::State::Stopped || state == SupervisedProcess::State::Failed)
            continue;
        const QString program = QFileInfo(process->entry().program).fileName();
        if (!deviceDaemons.contains(program) &&
            !(process->isAlive() && PortUsers::usesPorts(process->status().pid, udp)))
            continue;
        logInfo("setup", process->entry().name + ": ended for a search of its lines");
        process->stop();
        stopped.push_back({process, process->orders()});
    }
    return stopped;
}

void Setup::searchWhenStopped(const Stopped &stopped, QDeadlineTimer deadline, bool ask, const Reply &reply) {
    const auto ends = std::find_if(stopped.begin(), stopped.end(), [](const Released &one) {
        return one.process && one.process->isAlive() && one.process->orders() == one.orders;
    });
    if (ends != stopped.end() && deadline.hasExpired()) {
        isSearching_ = false;
        startAgain(stopped);
        return reply.error(
            Error(ErrorCode::NotReady, QString("%1 did not end within %2 s; nothing was searched")
                                           .arg(ends->process->entry().name)
                                           .arg(endsWithin.count())));
    }
    if (ends != stopped.end())
        return QTimer::singleShot(look, this, [=] { searchWhenStopped(stopped, deadline, ask, reply); });
    search_.begin(searchOptions(ask), [this, stopped, reply](const Findings &findings) {
        QMetaObject::invokeMethod(
            this, [=] { onFound(findings, stopped, reply); }, Qt::QueuedConnection);
    });
}

QStringList Setup::startAgain(const Stopped &stopped) {
    QStringList names;
    for (const auto &[process, orders] : stopped) {
        if (!process || process->orders() != orders)
            continue;
        names.append(process->entry().name);
        process->start(); // one that has not ended as yet: when it has
    }
    return names;
}

void Setup::markSimulated(Findings &findings) const {
    for (const SupervisedProcess *const process : processes_()) {
        if (!process->isAlive())
            continue;
        for (FoundSerial &line : findings.serial)
            line.simulated = line.simulated || PortUsers::holdsFarEnd(process->status().pid, line.device);
        if (!process->entry().program.endsWith("hermes-simulator"))
            continue;
        for (FoundLidar &lidar : findings.lidars)
            lidar.simulated = QHostAddress(lidar.address).isLoopback();
    }
}

void Setup::onFound(Findings findings, const Stopped &stopped, const Reply &reply) {
    isSearching_ = false;
    markSimulated(findings);
    findings.restarted = startAgain(stopped);
    found_ = findings;
    reply.result(asJson(findings));
}

} // namespace hermes::supervisor
