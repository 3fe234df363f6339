#include "gui/desktop/model/EventWatch.h"

#include "gui/desktop/drive/OwnName.h"
#include "gui/desktop/widgets/ForeignText.h"

#include <utility>

namespace hermes::desktop {
namespace {

constexpr int longestEvent = 300, longestItem = 30;

Event::Level levelOf(const QString &word) {
    return word == "error" ? Event::Level::Error : Event::Level::Warning;
}

/// Of a record that tells who stopped a robot, and who released it.
bool isOfStop(const LogMessage &record) {
    return record.level == "info" && record.source == "stop";
}

QString keyOf(const DaemonLink &daemon, const QString &what) {
    return daemon.address() + '\n' + what;
}

/// Without its address, of which its name tells more.
QString whyAway(const DaemonLink &daemon) {
    const QString reason = daemon.reason().section(".\n", 0, 0), address = daemon.address() + ": ";
    const int at = reason.indexOf(address);
    return at < 0 ? reason : reason.mid(at + address.size());
}

/// The supervisor says that nobody wants it to run, or tells itself what is wrong with it.
bool isAccountedFor(const ProcessStatus *process) {
    return process && process->state != "running";
}

} // namespace

EventWatch::EventWatch(Fleet &fleet, LogFeed &log, const DriveControl &drive, Events &events, QObject *parent)
    : QObject(parent)
    , fleet_(fleet)
    , events_(events) {
    connect(&log, &LogFeed::recorded, this, &EventWatch::onRecord);
    connect(&fleet, &Fleet::changed, this, &EventWatch::watchAll);
    connect(&drive, &DriveControl::changed, this, [this, &drive] { lookAtControl(drive); });
    watchAll();
}

void EventWatch::watchAll() {
    QSet<const DaemonLink *> gone;
    for (auto one = watched_.begin(); one != watched_.end(); ++one)
        gone.insert(one.key());
    for (const auto &robot : fleet_.robots())
        for (DaemonLink *daemon : robot->daemons()) {
            gone.remove(daemon);
            watch(*robot, *daemon);
        }
    for (const DaemonLink *daemon : qAsConst(gone)) { // of no robot: nobody misses it
        events_.endAll(keyOf(*daemon, {}));
        watched_[daemon].ailing.clear();
    }
}

void EventWatch::watch(const Robot &robot, DaemonLink &daemon) {
    if (!watched_.contains(&daemon)) {
        watched_[&daemon].connected.start();
        connect(&daemon, &DaemonLink::ready, this,
                [this, link = &daemon] { watched_[link].connected.start(); });
        connect(&daemon, &QObject::destroyed, this, [this, link = &daemon, begin = keyOf(daemon, {})] {
            watched_.remove(link);
            events_.endAll(begin);
        });
    }
    const QString name = nameOf(daemon), before = std::exchange(watched_[&daemon].name, name);
    if (!before.isEmpty() && before != name)
        events_.rename(before, name); // one form of it in all of the list
    lookAtLink(robot, daemon);
    lookAtHealth(daemon);
}

void EventWatch::lookAtLink(const Robot &robot, const DaemonLink &daemon) {
    const bool isMissed = daemon.isKnown() && (!daemon.isConnected() || daemon.isSilent());
    const QString key = keyOf(daemon, "link");
    if (!isMissed || isAccountedFor(robot.process(daemon)))
        return events_.ends(key);
    events_.goesOn(key, Event::Level::Error, nameOf(daemon),
                   daemon.isSilent()
                       ? tr("It is connected, but does not answer")
                       : tr("No connection: %1").arg(shortLine(inPlainWords(whyAway(daemon)), longestEvent)));
}

void EventWatch::lookAtHealth(const DaemonLink &daemon) {
    Watched &watched = watched_[&daemon];
    if (!daemon.isConnected() || !watched.connected.hasExpired(std::chrono::milliseconds(settling).count()))
        return; // what was wrong may still be
    QStringList now;
    for (const HealthItem &item : daemon.status().health) {
        if (item.level == "ok" || now.size() == maxItems)
            continue;
        const QString key = keyOf(daemon, "health " + shortLine(item.name, longestItem));
        const QString text = shortLine(inPlainWords(item.name + ": " + item.message), longestEvent);
        events_.goesOn(key, levelOf(item.level), nameOf(daemon), text, text.contains(ownName()));
        now.append(key);
    }
    for (const QString &key : qAsConst(watched.ailing))
        if (!now.contains(key))
            events_.ends(key);
    watched.ailing = now;
}

void EventWatch::onRecord(DaemonLink *daemon, const LogMessage &record, LogFeed::When when) {
    if (record.source == "health")
        return; // known from the status
    const bool isAlarming = record.level == "warning" || record.level == "error";
    if (!isAlarming && (!isOfStop(record) || record.text.contains(ownName())))
        return; // what was done from this window needs no note
    const auto level = isAlarming ? levelOf(record.level) : Event::Level::Info;
    const QString text = shortLine(inPlainWords(record.source + ": " + record.text), longestEvent);
    if (when == LogFeed::When::Now)
        events_.happened(level, nameOf(*daemon), text);
    else // what came while the link was away was seen by nobody
        events_.happenedBefore(level, nameOf(*daemon), text, record.stamp, when == LogFeed::When::Before);
}

void EventWatch::lookAtControl(const DriveControl &drive) {
    const QString holder = drive.holder();
    const bool isSame = std::exchange(robot_, fleet_.robot()) == fleet_.robot();
    if (std::exchange(holder_, holder) == holder && isSame)
        return;
    if (robot_ && drive.isHeldByOther() && holder != ownName())
        events_.happened(Event::Level::Info, fleet_.titleOf(*robot_),
                         tr("%1 has taken the control").arg(shortLine(holder, 80)));
}

QString EventWatch::nameOf(const DaemonLink &daemon) const {
    const Robot *const robot = fleet_.robotOf(&daemon);
    return robot && fleet_.robots().size() > 1 ? fleet_.titleOf(*robot) + ", " + daemon.name()
                                               : daemon.name();
}

} // namespace hermes::desktop
