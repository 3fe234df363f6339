// What the engine tells about itself: health items, and the state of each trigger.
#include "daemons/softwaretrigger/TriggerEngine.h"

namespace hermes {

QJsonObject TriggerEngine::state() const {
    QJsonObject result;
    for (const auto &[id, trigger] : triggers_) {
        const QJsonValue last = trigger.last.isEmpty() ? QJsonValue() : QJsonValue(trigger.last);
        result.insert(id, QJsonObject{{"armed", trigger.definition.armed},
                                      {"fired", double(trigger.seq)},
                                      {"missed", double(trigger.missed)},
                                      {"failed_actions", double(trigger.failedActions)},
                                      {"jitter", trigger.jitter.toJson()},
                                      {"last", last},
                                      {"problem", trigger.watch ? trigger.watch->problem() : QString()},
                                      {"watched", trigger.watch ? trigger.watch->state() : QJsonObject()}});
    }
    return result;
}

QStringList TriggerEngine::healthItems() {
    return {"schedule", "targets", "serial_lines", "actions", "firings_log"};
}

EngineHealth TriggerEngine::health(const QString &item) const {
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

EngineHealth TriggerEngine::scheduleHealth() const {
    QJsonObject values = jitter_.toJson();
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
        return {HealthLevel::Warn, QString("%1 firings were missed").arg(missed), values};
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

EngineHealth TriggerEngine::actionHealth() const {
    bool failing = false; // the last firing of any
    for (const auto &[id, trigger] : triggers_)
        failing = failing || trigger.last.value("ok") == QJsonValue(false);
    return {failing ? HealthLevel::Warn : HealthLevel::Ok,
            failing ? lastFailure_ : QString("%1 have failed").arg(failedActions_),
            {{"failed", double(failedActions_)}, {"under_way", int(underWay_.size())}}};
}

EngineHealth TriggerEngine::logHealth() const {
    const QJsonObject values = log_.toJson();
    const QString error = values["error"].toString();
    const double lost = values["lost"].toDouble();
    if (!error.isEmpty())
        return {HealthLevel::Failed, error, values};
    if (lost > 0)
        return {HealthLevel::Warn, QString("%1 firings are missing in the log").arg(lost), values};
    return {HealthLevel::Ok,
            values["folder"].toString().isEmpty() ? QString("none: firings.folder is empty")
                                                  : QString("writing"),
            values};
}

} // namespace hermes
