// Where the lines and fixes of the serial logger come from: its ports, or a recording that is replayed.
#include "daemons/seriallogger/SerialLogger.h"
#include "protocol/wire/Fields.h"

namespace hermes::seriallogger {

ReplaySource::Actions SerialLogger::sourceActions() {
    ReplaySource::Actions actions;
    actions.live = [this](const Call &) -> Result<void> {
        openLive();
        return {};
    };
    actions.recording = [this](const Call &call, const StoredRecording &stored) {
        return openRecording(call, stored);
    };
    actions.duration_s = [this] { return std::optional<double>(player_.duration_s()); };
    actions.changed = [this] { updateHealth(); };
    return actions;
}

void SerialLogger::openLive() {
    source_.close();
    player_.stop();
    for (const auto &port : ports_)
        port->view().open();
    source_.opened(ReplaySource::State::Live, "the ports");
}

Result<void> SerialLogger::openRecording(const Call &call, const StoredRecording &stored) {
    source_.close();
    player_.stop();
    for (const auto &port : ports_)
        port->view().close(sinks(port->settings().name));
    const Result<void> begun = player_.start(
        stored, {call.number("speed"), false, call.flag("paused")}, call.number("delay_s"), viewFilled(),
        source_.whenEnded([this](const Result<void> &result) { replayEnded(result); }));
    if (begun)
        source_.opened(ReplaySource::State::Replay, stored.folder);
    else
        openLive();
    return begun;
}

void SerialLogger::replayEnded(const Result<void> &result) {
    for (const auto &track : player_.tracks())
        track->view->close(sinks(track->port));
    source_.end(result);
    publish("serial", [this] { return state(); });
}

void SerialLogger::updateSourceHealth() {
    if (source_.state() == ReplaySource::State::Live)
        health().remove("source");
    else if (!source_.error().isEmpty())
        health().set("source", HealthLevel::Failed, source_.error());
    else
        health().set("source", HealthLevel::Ok,
                     "lines come from " + source_.name() +
                         ", not from the ports; those are recorded all the same");
}

} // namespace hermes::seriallogger
