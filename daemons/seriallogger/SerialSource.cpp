// Where the lines and fixes of the serial logger come from: its ports, or a recording that is replayed.
#include "daemons/seriallogger/SerialLogger.h"

#include "common/Log.h"
#include "protocol/wire/Fields.h"

namespace hermes {

Result<QJsonValue> SerialLogger::openSource(const Call &call) {
    const bool live = call.has("live") && call.flag("live");
    if (live == call.has("recording"))
        return invalidParams({{"live", call.value("live"), "true, without recording"},
                              {"recording", call.value("recording"), "the name of one, without live"}},
                             "either live: true or recording: NAME expected");
    if (live) {
        endReplay();
        openViews();
        logInfo("source", "lines come from the ports");
    } else if (const Result<void> result = openRecording(call); !result) {
        return result.error();
    }
    updateHealth();
    return asJson(sourceState());
}

Result<void> SerialLogger::openRecording(const Call &call) {
    const Result<StoredRecording> stored =
        StoredRecording::find(settings().text("record.folder"), call.text("recording"), identity().name);
    if (!stored)
        return stored.error();
    endReplay();
    for (const auto &port : ports_)
        port->view().close(sinks(port->settings().name));
    const auto ended = [this, generation = generation_](const Result<void> &result) {
        const auto tell = [this, generation, result] {
            if (generation == generation_) // else another was opened meanwhile
                replayEnded(result);
        };
        QMetaObject::invokeMethod(this, tell, Qt::QueuedConnection);
    };
    SerialPlayer::Options options;
    options.speed = speed_ = call.number("speed");
    options.delay_s = call.number("delay_s");
    options.paused = call.flag("paused");
    const Result<void> begun = player_.start(*stored, options, viewFilled(), ended);
    if (!begun) {
        openViews();
        return begun;
    }
    source_ = Source::Replay;
    sourceName_ = stored->folder;
    logInfo("source", "lines come from " + sourceName_);
    return {};
}

void SerialLogger::endReplay() {
    ++generation_;
    player_.stop();
    source_ = Source::Live;
    sourceName_.clear();
    sourceError_.clear();
}

void SerialLogger::openViews() {
    for (const auto &port : ports_)
        port->view().open();
}

void SerialLogger::replayEnded(const Result<void> &result) {
    for (const auto &track : player_.tracks())
        track->view->close(sinks(track->port));
    source_ = Source::Ended;
    if (result) {
        logInfo("source", sourceName_ + " has been played to its end");
    } else {
        sourceError_ = result.error().message;
        logError("source", sourceError_);
    }
    updateHealth();
    publish("serial", [this] { return state(); });
}

Result<QJsonValue> SerialLogger::pause(bool paused) {
    if (source_ != Source::Replay)
        return Error(ErrorCode::NotReady, "no replay is under way; source.open begins one");
    player_.setPaused(paused);
    return asJson(sourceState());
}

SourceStatus SerialLogger::sourceState() const {
    SourceStatus status;
    status.state = "live";
    if (source_ == Source::Live)
        return status;
    const SerialPlayer::Status replay = player_.status();
    status.state = source_ == Source::Replay ? "replay" : "ended";
    status.name = sourceName_;
    status.speed = speed_;
    status.paused = replay.paused;
    status.position_s = replay.position_s;
    status.duration_s = replay.duration_s;
    if (!sourceError_.isEmpty())
        status.error = sourceError_;
    return status;
}

void SerialLogger::updateSourceHealth() {
    if (source_ == Source::Live)
        health().remove("source");
    else if (!sourceError_.isEmpty())
        health().set("source", HealthLevel::Failed, sourceError_);
    else
        health().set("source", HealthLevel::Ok,
                     "lines come from " + sourceName_ +
                         ", not from the ports; those are recorded all the same");
}

} // namespace hermes
