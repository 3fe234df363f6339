#include "daemons/softwaretrigger/TriggerEngine.h"

#include "common/Realtime.h"
#include "common/Time.h"

namespace hermes::softwaretrigger {
TriggerEngine::TriggerEngine(const QString &folder, double fileBytes)
    : log_(folder, fileBytes, Firing::csvHeader()) {}

void TriggerEngine::start() {
    realtime_ = becomeRealtime(Schedule::realtimePriority);
    schedule_ = std::make_unique<Schedule>();
    runner_ = std::make_unique<ActionRunner>(nullptr);
}

void TriggerEngine::stop() {
    triggers_.clear();
    const auto unfinished = std::exchange(underWay_, {});
    for (const auto &firing : unfinished) {
        for (Firing::ActionResult &one : firing->results) {
            if (!one.ended)
                one.result = Error(ErrorCode::NotReady, "the daemon ended before the action did");
        }
        log_.append(firing->csvRows());
        Q_EMIT fired(firing->message());
        if (firing->ended)
            firing->ended(firing->message());
    }
    runner_.reset();
    schedule_.reset();
    log_.flush();
}

Result<void> TriggerEngine::fireNow(const QString &id, const QString &client, const Ended &ended) {
    const auto found = triggers_.find(id);
    if (found == triggers_.end() || !found->second.definition.armed)
        return Error(ErrorCode::NotReady, id + " is disarmed: trigger.arm first");
    FiringCause cause;
    cause.kind = "command";
    cause.client = client;
    fire(found->second, {{}, {}, 0, cause}, ended);
    return {};
}

void TriggerEngine::apply(const std::vector<TriggerDefinition> &definitions) {
    std::map<QString, const TriggerDefinition *> byId;
    for (const TriggerDefinition &definition : definitions)
        byId[definition.id] = &definition;
    for (auto trigger = triggers_.begin(); trigger != triggers_.end();) {
        const auto found = byId.find(trigger->first);
        if (found == byId.end()) {
            trigger = triggers_.erase(trigger);
            continue;
        }
        if (!found->second->armed || found->second->when != trigger->second.definition.when)
            trigger->second.watch.reset();
        ++trigger;
    }
    runner_->use(definitions);
    for (const TriggerDefinition &definition : definitions) {
        Trigger &trigger = triggers_[definition.id];
        trigger.definition = definition;
        if (definition.armed && !trigger.watch)
            watch(trigger);
    }
}

void TriggerEngine::watch(Trigger &trigger) {
    // The watch ends before its trigger does.
    trigger.watch = Watch::make(trigger.definition, *schedule_, runner_->targets(),
                                {[this, &trigger](const Occasion &occasion) { fire(trigger, occasion); },
                                 [&trigger] { ++trigger.missed; }});
}

void TriggerEngine::fire(Trigger &trigger, const Occasion &occasion, const Ended &ended) {
    const auto firing = std::make_shared<Firing>();
    firing->id = trigger.definition.id;
    firing->seq = ++trigger.seq;
    firing->occasion = occasion;
    const QString kind = trigger.definition.text("kind");
    QString &cause = firing->occasion.cause.kind;
    if (cause.isEmpty()) // trigger.fire has one of its own
        cause = kind;
    const Moment now = Moment::now();
    firing->stamp = now.stamp();
    firing->mono = now.mono();
    firing->ended = ended;
    firing->results.resize(trigger.definition.actions.size());
    trigger.missed += occasion.missed;
    if (cause == kind)
        trigger.jitter.add(firing->late_s());
    if (cause == "period")
        jitter_.add(firing->late_s());
    underWay_.insert(firing);
    for (size_t i = 0; i < firing->results.size(); ++i)
        firing->results[i].action = trigger.definition.actions[i].name();
    for (size_t i = 0; i < firing->results.size(); ++i)
        beginAction(firing, i, trigger.definition.actions[i]);
    fireFollowers(*firing);
    endIfOver(firing);
}

void TriggerEngine::beginAction(const std::shared_ptr<Firing> &firing, size_t index,
                                const ActionDefinition &action) {
    runner_->run(action, [this, firing, index, begun = monotonicNow()](const Result<QJsonValue> &result) {
        Firing::ActionResult &one = firing->results[index];
        one.ended = true;
        one.duration_s = monotonicNow() - begun;
        one.result = result;
        endIfOver(firing);
    });
}

void TriggerEngine::fireFollowers(const Firing &firing) {
    for (auto &[id, trigger] : triggers_) {
        if (trigger.definition.armed && trigger.definition.cause() == Cause::Trigger &&
            trigger.definition.text("trigger") == firing.id) {
            FiringCause cause;
            cause.trigger = firing.id;
            cause.triggerSeq = firing.seq;
            fire(trigger, {firing.mono, {}, 0, cause});
        }
    }
}

void TriggerEngine::endIfOver(const std::shared_ptr<Firing> &firing) {
    if (!firing->isOver() || underWay_.erase(firing) == 0)
        return;
    const FiringMessage message = firing->message();
    log_.append(firing->csvRows());
    Q_EMIT fired(message);
    for (const Firing::ActionResult &one : firing->results) {
        if (!one.result)
            lastFailure_ = firing->id + ": " + one.action + ": " + one.result.error().message;
    }
    failedActions_ += quint64(firing->failures());
    const auto trigger = triggers_.find(firing->id);
    if (trigger != triggers_.end()) {
        trigger->second.failedActions += quint64(firing->failures());
        trigger->second.last = message;
    }
    if (firing->ended)
        firing->ended(message);
}

} // namespace hermes::softwaretrigger
