#include "daemons/softwaretrigger/ActionRunner.h"
#include "daemons/softwaretrigger/FiringLog.h"
#include "protocol/wire/JsonText.h"

namespace hermes::softwaretrigger {

namespace {

constexpr int largestResult = 1000; // bytes of JSON; a larger result is not repeated

ActionOutcome outcomeOf(const Firing::ActionResult &one) {
    ActionOutcome outcome{one.action, one.result.ok(), one.duration_s, {}, {}};
    if (!one.result)
        outcome.error = {one.result.error().code, one.result.error().message};
    else if (compactJson(*one.result).size() <= largestResult)
        outcome.result = *one.result;
    return outcome;
}

} // namespace

FiringMessage Firing::message() const {
    FiringMessage told{id, seq, stamp, mono, late_s(), occasion.missed, occasion.cause, failures() == 0, {}};
    for (const ActionResult &one : results)
        told.results.push_back(outcomeOf(one));
    return told;
}

QByteArray Firing::csvRows() const {
    const QByteArray head = QByteArray::number(stamp, 'f', 6) + ',' + QByteArray::number(mono, 'f', 6) + ',' +
                            csvField(id) + ',' + QByteArray::number(seq) + ',' +
                            csvField(occasion.cause.kind) + ',' + QByteArray::number(late_s(), 'f', 6) + ',' +
                            QByteArray::number(occasion.missed) + ',';
    if (results.empty())
        return head + ",1,0,\n";
    QByteArray rows;
    for (const ActionResult &one : results)
        rows += head + csvField(one.action) + (one.result ? ",1," : ",0,") +
                QByteArray::number(one.duration_s, 'f', 6) + ',' +
                (one.result ? QByteArray() : csvField(one.result.error().message)) + '\n';
    return rows;
}

void ActionRunner::use(const std::vector<TriggerDefinition> &definitions) {
    using Kind = ActionDefinition::Kind;
    QSet<QString> daemons;
    SerialLines::Wanted lines;
    bool gpio = false;
    for (const TriggerDefinition &definition : definitions) {
        if (!watchedDaemon(definition).isEmpty())
            daemons.insert(watchedDaemon(definition));
        for (const ActionDefinition &action : definition.actions) {
            if (action.kind == Kind::Call)
                daemons.insert(action.daemon);
            if (action.kind == Kind::Serial || action.kind == Kind::Pulse)
                lines[action.url];
            if (action.kind == Kind::Pulse)
                lines[action.url].insert(
                    int(action.dtr ? SerialLines::Signal::Dtr : SerialLines::Signal::Rts));
            gpio = gpio || action.kind == Kind::Gpio;
        }
    }
    targets_.use(daemons);
    serialLines_.use(lines);
    if (!gpio)
        gpioLines_.close();
}

void ActionRunner::run(const ActionDefinition &action, const Done &done) {
    switch (action.kind) {
    case ActionDefinition::Kind::Call:
        return targets_.call(action.daemon, action.method, action.params, action.timeout_s, done);
    case ActionDefinition::Kind::Serial:
        return serialLines_.send(action.url, action.bytes, done);
    case ActionDefinition::Kind::Pulse: {
        const auto signal = action.dtr ? SerialLines::Signal::Dtr : SerialLines::Signal::Rts;
        return pulses_.start(
            action.name(), action.length_s,
            [this, signal, url = action.url](bool on) { return serialLines_.set(url, signal, on); }, done);
    }
    case ActionDefinition::Kind::Gpio:
        return pulses_.start(
            action.name(), action.length_s,
            [this, chip = action.chip, offset = action.offset](bool on) {
                return gpioLines_.set(chip, offset, on);
            },
            done);
    }
}

} // namespace hermes::softwaretrigger
