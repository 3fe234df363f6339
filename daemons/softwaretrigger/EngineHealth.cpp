// What the engine tells about itself: health items, and the state of each trigger.
#include "daemons/softwaretrigger/TriggerEngine.h"
#include "protocol/wire/Fields.h"

namespace hermes::softwaretrigger {

std::map<QString, TriggerState> TriggerEngine::state() const {
    std::map<QString, TriggerState> result;
    for (const auto &[id, trigger] : triggers_)
        result[id] = {trigger.definition.armed,
                      trigger.seq,
                      trigger.missed,
                      trigger.failedActions,
                      trigger.jitter.summary(),
                      trigger.last,
                      trigger.watch ? trigger.watch->problem() : QString(),
                      trigger.watch ? trigger.watch->state() : WatchedState()};
    return result;
}

QStringList TriggerEngine::healthItems() {
    return {"schedule", "targets", "serial_lines", "actions", "firings_log"};
}

EngineHealth TriggerEngine::health(const QString &item) {
    switch (healthItems().indexOf(item)) {
    case 0:
        return scheduleHealth();
    case 1:
        return targetHealth();
    case 2:
        return lineHealth();
    case 3:
        return actionHealth();
    default:
        return logHealth();
    }
}

EngineHealth TriggerEngine::scheduleHealth() {
    QJsonObject values = asJson(jitter_.summary()).toObject();
    double missed = 0;
    QStringList problems;
    for (const auto &[id, trigger] : triggers_) {
        missed += double(trigger.missed);
        const QString problem = trigger.watch ? trigger.watch->problem() : QString();
        if (!problem.isEmpty())
            problems.append(id + ": " + problem);
    }
    values.insert("missed", missed);
    values.insert("realtime", realtime_ && schedule_->isRealtime());
    if (!problems.isEmpty())
        return {HealthLevel::Warn, problems.join("; "), values};
    if (missed > 0)
        return {pastMissed_.level(missed), QString("%1 firings were missed").arg(missed), values};
    return {HealthLevel::Ok, QString("%1 triggers").arg(triggers_.size()), values};
}

EngineHealth TriggerEngine::targetHealth() const {
    const QStringList away = runner_->targets().unreachable();
    return {away.isEmpty() ? HealthLevel::Ok : HealthLevel::Warn,
            away.isEmpty() ? QString("connected") : "not connected: " + away.join(", "),
            runner_->targets().toJson()};
}

EngineHealth TriggerEngine::lineHealth() const {
    const QStringList closed = runner_->serialLines().closed();
    return {closed.isEmpty() ? HealthLevel::Ok : HealthLevel::Warn,
            closed.isEmpty() ? QString("open") : "not open: " + closed.join(", "),
            runner_->serialLines().toJson()};
}

EngineHealth TriggerEngine::actionHealth() {
    bool failing = false; // the last firing of any
    for (const auto &[id, trigger] : triggers_)
        failing = failing || (trigger.last && !trigger.last->ok);
    const HealthLevel past = pastFailures_.level(double(failedActions_));
    const QString last = failedActions_ > 0 ? ", the last: " + lastFailure_ : QString();
    return {failing ? past : HealthLevel::Ok,
            QString("%1 have failed").arg(failedActions_) + last,
            {{"failed", double(failedActions_)}, {"under_way", int(underWay_.size())}}};
}

EngineHealth TriggerEngine::logHealth() {
    const FiringLog::State log = log_.state();
    const QJsonObject values = asJson(log).toObject();
    if (!log.error.isEmpty())
        return {HealthLevel::Failed, log.error, values};
    if (log.lost > 0)
        return {pastLost_.level(double(log.lost)), QString("%1 firings are missing in the log").arg(log.lost),
                values};
    return {HealthLevel::Ok,
            log.folder.isEmpty() ? QString("none: firings.folder is empty") : QString("writing"), values};
}

} // namespace hermes::softwaretrigger
