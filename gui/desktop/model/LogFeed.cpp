#include "gui/desktop/model/LogFeed.h"

#include "protocol/wire/Fields.h"

namespace hermes::desktop {

LogFeed::LogFeed(Fleet &fleet, QObject *parent)
    : QObject(parent)
    , fleet_(fleet) {
    connect(&fleet, &Fleet::changed, this, &LogFeed::followAll);
    followAll();
}

void LogFeed::followAll() {
    for (const auto &robot : fleet_.robots())
        for (DaemonLink *daemon : robot->daemons())
            if (!followed_.contains(daemon) && daemon->hasTopic("log"))
                follow(daemon);
}

void LogFeed::follow(DaemonLink *daemon) {
    followed_.insert(daemon, {});
    connect(daemon, &QObject::destroyed, this, [this, daemon] { followed_.remove(daemon); });
    connect(daemon, &DaemonLink::ready, this, [this, daemon] { readLast(daemon); });
    followed_[daemon].log =
        daemon->subscribe("log", {{"queue", lastRecords}}, [this, daemon](const TopicUpdate &update) {
            take(daemon, update.data, When::Now);
        });
    readLast(daemon);
}

/// Of those that nobody has told here as yet.
void LogFeed::readLast(DaemonLink *daemon) {
    Followed &followed = followed_[daemon];
    followed.stamps.clear();
    daemon->call("log.tail", {{"count", lastRecords}}, this,
                 [this, daemon, latest = followed.latest](const auto &tail) {
                     if (!tail || !tail->isArray() || !followed_.contains(daemon))
                         return;
                     const WireValue records(*tail);
                     for (std::size_t i = records.size() - qMin(records.size(), std::size_t(lastRecords));
                          i < records.size(); ++i)
                         take(daemon, records[i], latest < 0 ? When::Before : When::Missed, latest);
                 });
}

void LogFeed::take(DaemonLink *daemon, WireView record, When when, double after) {
    ReadReport report;
    const auto read = readMessage<LogMessage>(record, report);
    const LogMessage message = read ? *read : LogMessage{-1, "warning", "log", report.text()};
    Followed &followed = followed_[daemon];
    if (when != When::Now && read && (message.stamp <= after || followed.stamps.contains(message.stamp)))
        return;
    followed.latest = std::max(followed.latest, message.stamp);
    if (when == When::Now && followed.stamps.size() < lastRecords)
        followed.stamps.insert(message.stamp);
    Q_EMIT recorded(daemon, message, when);
}

} // namespace hermes::desktop
