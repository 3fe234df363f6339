#include "daemons/recorder/Recorder.h"

#include "common/Log.h"
#include "common/OwnRobot.h"
#include "common/Project.h"
#include "common/Time.h"
#include "common/client/DaemonAddress.h"
#include "common/files/SavedFile.h"
#include "protocol/wire/Fields.h"

#include <QDateTime>

namespace hermes::recorder {
namespace {

constexpr std::chrono::seconds afterAlarm{5}; // that the ring is recorded on
constexpr qint64 maxEndedBytes = 4096;
constexpr std::chrono::seconds forLoggers{2}; // who still records tells what, and that counts first
constexpr double maxAway_s = 3600; // of all daemons at once; later a session does not go on by itself
constexpr char ringPrefix[] = "ring-";

} // namespace

Recorder::Recorder()
    : Daemon({"recorder", "Recorder",
              "Records all that a robot does as sessions: what its loggers receive and every topic of every "
              "daemon; replays them as they were"})
    , daemons_(ownRobot().value_or(RobotIdentity()).id, identity().name)
    , recording_("recorder", settings(), health(), file_, Recording::Files::Several)
    , return_([this](const QString &name) {
        RobotDaemons::Daemon *const daemon = daemons_.find(name);
        return daemon ? daemon->client.get() : nullptr;
    })
    , session_(daemons_, ownMember()) {
    declareOwnCommands();
    declareSettings();
    addTopic(Topic("session", "What the recorder does, at each change and each second while it records")
                 .carries<SessionState>()
                 .snapshot([this] { return session_.state(); }));
    addTopic(Topic("marks", "Each text that somebody puts into a session").carries<SessionMark>());
    declareCommands();
    declareReplay();
    declareStudies();
    work_.setMaxThreadCount(2);
    exports_.setMaxThreadCount(1);
    connect(&recording_, &Recording::changed, this, &Recorder::recordingChanged);
    connect(&recording_, &Recording::completed, this, &Recorder::resume);
    connect(&topics_, &TopicRecorder::alarmed, this, &Recorder::keepRing);
    ringEnd_.setSingleShot(true);
    connect(&ringEnd_, &QTimer::timeout, this, [this] {
        if (session_.isBusy() && session_.state().session == ringSession_)
            session_.stop([](const auto &) {});
    });
    connect(&session_, &SessionControl::resumed, this,
            [this](const QString &name) { showMarks(name, Reply([](const Result<QJsonValue> &) {})); });
    connect(&session_, &SessionControl::sessionEnded, this, &Recorder::keepEnded);
    connect(&session_, &SessionControl::changed, this, &Recorder::sessionChanged);
}

Result<void> Recorder::start() {
    file_.setQueueBytes(std::size_t(settings().integer("record.queue_bytes")));
    recording_.open();
    QFile ended(endedPath());
    if (ended.open(QIODevice::ReadOnly))
        session_.setEnded(QString::fromUtf8(ended.read(maxEndedBytes)).split('\n'));
    source_.opened(ReplaySource::State::Live, "the daemons");
    follow();
    openRing();
    setState(DaemonState::Running);
    updateHealth();
    return {};
}

void Recorder::stop() {
    topics_.end();
    source_.close();
    player_.stop();
    return_.end();
    recording_.close();
    isEnding_ = true;
    work_.waitForDone();
    exports_.waitForDone();
}

void Recorder::settingsChanged(const QStringList &paths) {
    if (paths.contains("daemons"))
        follow();
    if (paths.contains("topics") || paths.contains("record.ring_s"))
        openRing();
}

void Recorder::follow() {
    QStringList addresses;
    for (const QString &one : settings().values()["daemons"].toVariant().toStringList())
        if (const Result<QString> address = daemonAddress(one))
            addresses.append(*address);
    if (addresses.isEmpty())
        for (const QString &name : daemonNames())
            addresses.append(*daemonAddress(name));
    addresses += server().addresses().mid(0, 1); // its own topics are recorded as all others
    daemons_.follow(addresses);
}

SessionMember Recorder::ownMember() {
    SessionMember own;
    own.name = identity().name;
    own.replays = own.seeks = own.setsSpeed = own.endsOne = true;
    own.send = [this](const QString &method, const QJsonObject &params, const Client::Callback &done,
                      std::chrono::milliseconds) {
        Call call;
        call.clientName = "the session";
        own_.execute({QJsonValue(1), method, params}, call,
                     Reply([done](const Result<QJsonValue> &result) { done(result); }));
    };
    return own;
}

/// Its own, those that are to stay live, and loggers that replay their part themselves.
QStringList Recorder::notReplayed() {
    QStringList names = session_.player().options().without;
    names.append(identity().name);
    for (const RecordedPart &part : session_.player().session().parts)
        names.append(part.member.name);
    return names;
}

ReplaySource::Actions Recorder::sourceActions() {
    ReplaySource::Actions actions;
    actions.live = [this](const Call &) -> Result<void> {
        source_.close();
        player_.stop();
        return_.end();
        source_.opened(ReplaySource::State::Live, "the daemons");
        return {};
    };
    actions.recording = [this](const Call &call, const StoredRecording &stored) -> Result<void> {
        source_.close();
        player_.stop();
        duration_s_ = stored.length_s + call.number("delay_s");
        const auto begin_ns = std::int64_t((stored.start_s - call.number("delay_s")) * 1e9);
        const Result<void> begun = player_.start(
            stored, {call.number("speed"), false, call.flag("paused")}, begin_ns, notReplayed(),
            [this](const RecordedMessage &message) { return return_.take(message); },
            source_.whenEnded([this](const Result<void> &result) { source_.end(result); }));
        if (begun)
            source_.opened(ReplaySource::State::Replay, stored.folder);
        return begun;
    };
    actions.duration_s = [this] { return std::optional<double>(duration_s_); };
    actions.changed = [this] { updateHealth(); };
    return actions;
}

void Recorder::recordingChanged() {
    if (recording_.isActive())
        return topics_.begin(keepsRing_);
    topics_.end();
    openRing(); // with the settings as they are now
}

QString Recorder::endedPath() {
    return settings().text("record.folder") + "/.recorder.ended";
}

/// A logger that was away as its session was stopped does not revive it, also after a restart.
void Recorder::keepEnded(const QString &session) {
    QFile file(endedPath());
    QByteArray ids;
    if (file.open(QIODevice::ReadOnly))
        ids = file.read(maxEndedBytes / 2);
    if (const Result<void> saved = saveFile(endedPath(), session.toUtf8() + '\n' + ids); !saved)
        logWarning("session", saved.error().message);
}

/// A power cut, a killed supervisor and an update do not end what nobody has stopped.
void Recorder::resume(const QJsonObject &latest, double since_s) {
    const QString ended = latest["ended"].toString();
    RecordingStatus status;
    status.name = latest["name"].toString();
    status.session = latest["session"].toString();
    status.start = latest["start"].toDouble();
    status.duration_s = 0; // the recording that goes on tells it
    if (since_s < maxAway_s && (ended == "cut off" || ended == "shut down") &&
        !latest["name"].toString().startsWith(ringPrefix))
        QTimer::singleShot(forLoggers, this, [this, status] { session_.resume(status); });
}

void Recorder::openRing() {
    topics_.setRules(topicRules(settings().values()["topics"]));
    topics_.openRing(settings().number("record.ring_s"),
                     std::size_t(settings().integer("record.queue_bytes")) /
                         2); // all of it fits into the queue
}

void Recorder::keepRing(const QString &why) {
    if (session_.isBusy() || session_.isReplaying())
        return;
    keepsRing_ = true;
    file_.setBegin(topics_.ringBegin());
    const QString name = ringPrefix + QDateTime::currentDateTime().toString("yyyy-MM-dd_HH-mm-ss");
    session_.start(name, {identity().name}, [this, name, why](const Result<SessionState> &state) {
        keepsRing_ = false;
        file_.setBegin({});
        if (!state)
            return logError("ring", "the last seconds could not be kept: " + state.error().message);
        logWarning("ring", QString("the last seconds are kept as \"%1\": %2").arg(name, why));
        ringSession_ = state->session;
        ringEnd_.start(afterAlarm);
        mark(why);
    });
}

Result<SessionMark> Recorder::mark(const QString &text) {
    const Result<SessionMark> mark = session_.mark(text);
    if (mark)
        publish("marks", *mark);
    return mark;
}

void Recorder::sessionChanged() {
    publish("session", [this] { return session_.state(); });
    updateHealth();
}

void Recorder::updateHealth() {
    const SessionState state = session_.state();
    const QStringList lines = state.problems + return_.problems();
    const QString doing = state.name.isEmpty() ? state.state : state.state + ' ' + state.name;
    health().set("session", lines.isEmpty() ? HealthLevel::Ok : HealthLevel::Warn,
                 lines.isEmpty() ? doing : doing + ": " + lines.join("; "));
    int known = 0;
    for (const auto &entry : daemons_.all())
        known += entry.second->isKnown && entry.second->name != identity().name;
    health().set("daemons", state.silent.isEmpty() ? HealthLevel::Ok : HealthLevel::Warn,
                 state.silent.isEmpty() ? QString("%1 daemons of the robot answer").arg(known)
                                        : "no answer from " + state.silent.join(", "));
}

} // namespace hermes::recorder
