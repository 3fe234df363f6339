// Where the lines and fixes of the serial logger come from: its ports, or a recording that is replayed.
#include "daemons/seriallogger/SerialLogger.h"
#include "protocol/wire/Fields.h"

namespace hermes::seriallogger {

namespace {

/// Those of the recording, or what is usual where its sidecar does not tell.
PortSettings settingsOf(const QJsonObject &sidecar, const QString &port) {
    for (const PortSettings &settings : PortSettings::read(sidecar.value("settings").toObject()))
        if (settings.name == port)
            return settings;
    PortSettings usual;
    usual.name = port;
    return usual;
}

} // namespace

ReplaySource::Actions SerialLogger::sourceActions() {
    return player_.actions(
        [this] { openLive(); },
        [this](const Call &call, const StoredRecording &stored) { return openRecording(call, stored); },
        [this] { updateHealth(); });
}

void SerialLogger::openLive() {
    source_.close();
    player_.stop();
    replayed_.clear();
    for (const auto &port : ports_)
        port->view().open();
    source_.opened(ReplaySource::State::Live, "the ports");
}

Result<void> SerialLogger::openRecording(const Call &call, const StoredRecording &stored) {
    source_.close();
    player_.stop();
    replayed_.clear();
    for (const auto &port : ports_)
        port->view().close(sinks(port->settings().name, false));
    const Result<void> begun = player_.start(
        stored, {call.number("speed"), false, call.flag("paused")}, call.number("delay_s"),
        [this](const QString &port, const QJsonObject &sidecar) { return replayedQueue(port, sidecar); },
        viewFilled(), source_.whenEnded([this](const Result<void> &result) { replayEnded(result); }));
    if (begun)
        source_.opened(ReplaySource::State::Replay, stored.folder);
    else
        openLive();
    return begun;
}

ChunkQueue *SerialLogger::replayedQueue(const QString &port, const QJsonObject &sidecar) {
    const PortSettings settings = settingsOf(sidecar, port);
    if (settings.view == PortSettings::View::None)
        return nullptr;
    PortView &view = replayed_.emplace_back(port, settings).second;
    view.open();
    return &view.queue();
}

void SerialLogger::replayEnded(const Result<void> &result) {
    for (auto &[port, view] : replayed_)
        view.close(sinks(port, true));
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
