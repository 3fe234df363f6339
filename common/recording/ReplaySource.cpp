#include "common/recording/ReplaySource.h"

#include "common/Log.h"
#include "protocol/wire/Fields.h"

namespace hermes {
namespace {

constexpr const char *stateNames[]{"none", "live", "replay", "ended"};
constexpr qint64 roomTimeout_ms = 5000;

Field speedField() {
    return Field::number("speed", "Of the replay: 1 real time, 0 as fast as possible").range(0, 1000);
}

} // namespace

ReplaySource::ReplaySource(const QString &what, const QString &logger, const Settings &settings,
                           Playback &playback, Actions actions)
    : what_(what)
    , logger_(logger)
    , settings_(settings)
    , playback_(playback)
    , actions_(std::move(actions)) {}

void ReplaySource::close() {
    ++generation_;
    state_ = State::None;
    name_.clear();
    error_.clear();
}

void ReplaySource::opened(State state, const QString &name) {
    state_ = state;
    name_ = name;
    sinceRoom_.start();
    logInfo("source", what_ + " come from " + name);
}

ReplaySource::Ended ReplaySource::whenEnded(const Ended &done) {
    return [this, done, generation = generation_](const Result<void> &result) {
        const auto tell = [this, done, generation, result] {
            if (generation == generation_) // else another source was opened meanwhile
                done(result);
        };
        QMetaObject::invokeMethod(this, tell, Qt::QueuedConnection);
    };
}

bool ReplaySource::mayShow(bool hasRoom) {
    const bool isPatient = state_ == State::Replay && playback_.options().speed == 0;
    if (hasRoom || !isPatient)
        sinceRoom_.start();
    return hasRoom || !isPatient || sinceRoom_.elapsed() >= roomTimeout_ms;
}

void ReplaySource::end(const Result<void> &result) {
    state_ = State::Ended;
    if (result) {
        logInfo("source", name_ + " has been played to its end");
    } else {
        error_ = result.error().message;
        logError("source", error_);
    }
    actions_.changed();
}

SourceStatus ReplaySource::status() const {
    SourceStatus status;
    status.state = stateNames[int(state_)];
    status.name = name_;
    if (state_ == State::Replay || state_ == State::Ended) {
        const Playback::Status replay = playback_.status();
        status.speed = playback_.options().speed;
        status.loop = playback_.options().loop;
        status.loops = quint64(replay.loops);
        status.paused = replay.paused;
        status.position_s = replay.position_s;
        status.duration_s = actions_.duration_s();
    }
    if (!error_.isEmpty())
        status.error = error_;
    return status;
}

Result<void> ReplaySource::mayChange() const {
    if (actions_.records && actions_.records())
        return Error(ErrorCode::NotReady, "the source is being recorded; record.stop ends the recording");
    return {};
}

void ReplaySource::clientGone(quint64 client) {
    if (client != client_ || (state_ != State::Replay && state_ != State::Ended))
        return;
    client_ = 0;
    logWarning("source", "who replays is gone");
    if (const Result<void> live = actions_.live({}); !live)
        logError("source", live.error().message);
    actions_.changed();
}

Result<SourceStatus> ReplaySource::open(const Call &call) {
    const bool live = call.has("live") && call.flag("live");
    if (live + call.has("pcap") + call.has("recording") != 1) {
        std::vector<SchemaViolation> ways{
            {"live", call.value("live"), "true, without the others"},
            {"recording", call.value("recording"), "the name of one, without the others"}};
        if (actions_.pcap)
            ways.push_back({"pcap", call.value("pcap"), "a capture file, without the others"});
        return invalidParams(ways, QString("one of live: true%1 and recording: NAME expected")
                                       .arg(actions_.pcap ? ", pcap: FILE" : ""));
    }
    if (const Result<void> fine = mayChange(); !fine)
        return fine.error();
    client_ = call.flag("until_gone") ? call.client : 0;
    const Result<void> result = live                    ? actions_.live(call)
                                : call.has("recording") ? openRecording(call)
                                                        : actions_.pcap(call);
    actions_.changed();
    if (!result)
        return result.error();
    return status();
}

Result<void> ReplaySource::openRecording(const Call &call) {
    const Result<StoredRecording> stored =
        StoredRecording::find(settings_.text("record.folder"), call.text("recording"), logger_);
    return stored ? actions_.recording(call, *stored) : stored.error();
}

Command ReplaySource::openCommand(const QString &summary) {
    return Command("source.open", summary)
        .param(Field::boolean("live", "Show what is received").optional())
        .param(Field::text("recording", "Recording of this logger to replay, by its name").optional())
        .param(speedField().byDefault(1))
        .param(Field::boolean("paused", "Begin paused; source.pause lets it go on").byDefault(false))
        .param(Field::number("delay_s", "Time of the replay at which the recording begins")
                   .unit("s")
                   .range(0, 1e7)
                   .byDefault(0))
        .param(Field::boolean("until_gone", "A replay ends when the client that asks for it goes")
                   .byDefault(false))
        .example({{"recording", "drive"}}, QJsonObject{{"state", "replay"}, {"name", "/data/drive"}})
        .answers([this](const Call &call) { return open(call); });
}

std::vector<Command> ReplaySource::replayCommands() {
    return {
        whileReplaying(
            Command("source.seek", "Lets the replay go on from another time; beyond its end it ends. A "
                                   "paused one plays a quarter of a second, and stays paused")
                .param(
                    Field::number("t_s", "Seconds after the first record, of a recording after its beginning")
                        .unit("s")
                        .range(0, 1e7))
                .example({{"t_s", 60}},
                         QJsonObject{{"state", "replay"}, {"position_s", 60}, {"duration_s", 600}}),
            [this](const Call &call) { playback_.seek(call.number("t_s")); }),
        whileReplaying(Command("source.speed", "Makes the replay faster or slower")
                           .param(speedField())
                           .example({{"speed", 2}}, QJsonObject{{"state", "replay"}, {"speed", 2}}),
                       [this](const Call &call) { playback_.setSpeed(call.number("speed")); }),
        whileReplaying(Command("source.pause", "Pauses the replay, or lets it go on")
                           .param(Field::boolean("paused", "Whether it waits").byDefault(true))
                           .example({{"paused", true}}, QJsonObject{{"state", "replay"}, {"paused", true}}),
                       [this](const Call &call) { playback_.setPaused(call.flag("paused")); })};
}

Command ReplaySource::whileReplaying(Command command, const std::function<void(const Call &)> &action) {
    return command.gives<SourceStatus>().handler([this, action](const Call &call) -> Result<QJsonValue> {
        if (state_ != State::Replay)
            return Error(ErrorCode::NotReady, "no replay is running; source.open begins one");
        action(call);
        return asJson(status());
    });
}

} // namespace hermes
