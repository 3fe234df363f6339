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
    followed_.insert(daemon);
    connect(daemon, &QObject::destroyed, this, [this, daemon] { followed_.remove(daemon); });
    daemon->subscribe("log", {{"queue", lastRecords}},
                      [this, daemon](const TopicUpdate &update) { take(daemon, update.data, false); });
    daemon->call("log.tail", {{"count", lastRecords}}, this, [this, daemon](const auto &tail) {
        if (!tail || !tail->isArray() || !followed_.contains(daemon))
            return;
        const WireValue records(*tail);
        for (std::size_t i = records.size() - qMin(records.size(), std::size_t(lastRecords));
             i < records.size(); ++i)
            take(daemon, records[i], true);
    });
}

void LogFeed::take(DaemonLink *daemon, WireView record, bool isPast) {
    ReadReport report;
    const auto message = readMessage<LogMessage>(record, report);
    Q_EMIT recorded(daemon, message ? *message : LogMessage{-1, "warning", "log", report.text()}, isPast);
}

} // namespace hermes::desktop
