#include "daemons/softwaretrigger/ActionRunner.h"

#include "daemons/softwaretrigger/Watch.h"

#include <algorithm>

namespace hermes::softwaretrigger {

ActionRunner::ActionRunner(QObject *parent)
    : QObject(parent)
    , serialLines_(this)
    , pulses_(this) {}

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
