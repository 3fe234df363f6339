#include "daemons/scanner/Scanner.h"

#include "common/Log.h"
#include "common/recording/DiskError.h"
#include "protocol/wire/Fields.h"

#include <QJsonArray>

namespace hermes::scanner {
namespace {

using State = ReplaySource::State;

const QString portName = "scan"; // of its file
constexpr double stale_s = 1.5;  // no revolution is so slow
constexpr int retry_ms = 2;

QString toText(Interface::State state) {
    return state == Interface::State::Open      ? "open"
           : state == Interface::State::Opening ? "opening"
                                                : "closed";
}

std::optional<QString> known(const std::string &text) {
    return text.empty() ? std::nullopt : std::optional(QString::fromStdString(text));
}

} // namespace

Scanner::Scanner()
    : Daemon({"scanner", "Scanner",
              "Reads a laser scanner of one plane (RPLIDAR, LDROBOT, YDLIDAR, Hokuyo, SICK) or replays a "
              "recording of one, publishes "
              "each revolution, records its bytes"}) {
    declareSettings();
    declareTopics();
    declareCommands();
    recording_.setCondition([this]() -> Result<void> {
        noteScanner();
        return {};
    });
    health().provide("scanner", [this] { updateHealth(); });
    connect(&second_, &QTimer::timeout, this, &Scanner::tick);
    retry_.setSingleShot(true);
    connect(&retry_, &QTimer::timeout, this, &Scanner::processReplay);
    connect(this, &Daemon::clientGone, this, [this](quint64 client) { source_.clientGone(client); });
}

Result<void> Scanner::start() {
    const QString url = settings().text("scanner.url");
    if (!url.isEmpty()) {
        const auto note = [this](const QString &event, const QJsonObject &details) {
            if (event == "opened")
                logInfo("scanner", "the line is open");
            else if (event == "closed")
                logWarning("scanner", details.value("reason").toString());
            recorder_.note(event, details);
        };
        live_ = std::make_unique<LiveScanner>(
            url, scan::findScannerModel(settings().text("scanner.model").toStdString()), recordingQueue_,
            [this](const scan::Revolution &revolution) {
                if (!replayed_)
                    publishScan(revolution, false);
            },
            note);
    }
    recorder_.setPorts({{portName, url, &recordingQueue_, [this] {
                             const std::lock_guard<std::mutex> lock(mutex_);
                             return prerequisite_;
                         }}});
    recording_.open();
    if (live_)
        live_->start();
    openLive();
    second_.start(1000);
    setState(live_ ? DaemonState::Running : DaemonState::Ready);
    updateHealth();
    return {};
}

void Scanner::stop() {
    second_.stop();
    retry_.stop();
    source_.close();
    player_.stop();
    if (live_)
        live_->stop();
    recording_.close();
}

ReplaySource::Actions Scanner::sourceActions() {
    return player_.actions(
        [this] { openLive(); },
        [this](const Call &call, const StoredRecording &stored) { return openRecording(call, stored); },
        [this] { updateHealth(); });
}

void Scanner::openLive() {
    source_.close();
    player_.stop();
    replayed_.reset();
    replayEnd_.reset();
    if (live_)
        source_.opened(State::Live, settings().text("scanner.url"));
}

Result<void> Scanner::openRecording(const Call &call, const StoredRecording &stored) {
    openLive();
    source_.close();
    Result<void> begun = player_.start(
        stored, {call.number("speed"), false, call.flag("paused")}, call.number("delay_s"),
        [this](const QString &port, const QJsonObject &sidecar) { return replayedQueue(port, sidecar); },
        [this] { QMetaObject::invokeMethod(this, &Scanner::processReplay, Qt::QueuedConnection); },
        source_.whenEnded([this](const Result<void> &result) {
            replayEnd_ = result;
            processReplay();
        }));
    if (begun && !replayed_)
        begun = diskError(stored.folder + ": it does not tell which scanner was recorded", stored.folder);
    if (begun)
        source_.opened(State::Replay, stored.folder);
    else
        openLive();
    return begun;
}

ChunkQueue *Scanner::replayedQueue(const QString &port, const QJsonObject &sidecar) {
    for (const QJsonValue &file : sidecar.value("files").toArray()) {
        const scan::ScannerModel *const model =
            scan::findScannerModel(file["scanner"].toString().toStdString());
        if (file["port"] != port || !model || replayed_) // one scanner
            continue;
        replayed_ = std::make_unique<ScanReader>(
            *model, [this](const scan::Revolution &revolution) { publishScan(revolution, true); });
        replayed_->protocol().prepare(file["prerequisite"].toString().toStdString());
        replayed_->queue().open();
        return &replayed_->queue();
    }
    return nullptr;
}

void Scanner::processReplay() {
    if (!replayed_)
        return;
    if (!replayed_->process([this] { return source_.mayShow(hasRoom("scan2d")); })) {
        retry_.start(retry_ms);
    } else if (replayEnd_) {
        replayed_->finish();
        source_.end(*std::exchange(replayEnd_, std::nullopt));
        publish("scanner", [this] { return state(); });
    }
}

void Scanner::publishScan(const scan::Revolution &revolution, bool replayed) {
    if (hasSubscribers("scan2d")) {
        const ScanMessage message = toScanMessage(revolution, replayed);
        publish(
            "scan2d", [&] { return message; }, message.header.stamp);
    }
}

void Scanner::noteScanner() {
    if (!live_ || !live_->isFound())
        return;
    const ScanReader &reader = live_->reader();
    const scan::ScannerModel *const model = live_->model();
    const std::lock_guard<std::mutex> lock(mutex_);
    if (recording_.isActive() && !prerequisite_["prerequisite"].toString().isEmpty())
        return; // that of its first bytes
    prerequisite_ = {{"scanner", (model ? *model : reader.model()).name},
                     {"prerequisite", QString::fromStdString(reader.protocol().prerequisite())}};
}

void Scanner::tick() {
    noteScanner();
    updateHealth();
    publish("scanner", [this] { return state(); });
}

ScannerMessage Scanner::state() const {
    ScannerMessage state;
    state.source = source_.status();
    state.recording = recording_.status();
    state.line = "closed";
    if (live_) {
        const PortThread::State port = live_->port();
        state.url = live_->url();
        state.line = toText(port.carrier);
        state.bytes = port.counters.bytesIn;
    }
    if (!live_ && !replayed_)
        return state;
    const ScanReader &reader = shown();
    const scan::ScannerIdentity &identity = reader.protocol().identity();
    if (replayed_ || live_->isFound()) {
        const scan::ScannerModel *const named = replayed_ ? nullptr : live_->model();
        state.model = (named ? *named : reader.model()).name; // some that speak alike cannot be told apart
        state.device = known(identity.model);
        state.firmware = known(identity.firmware);
        state.serial = known(identity.serial);
    }
    state.rpm = reader.period_s() > 0 ? 60 / reader.period_s() : 0;
    state.beams = reader.beams();
    state.revolutions = reader.counts().revolutions;
    state.partial = reader.counts().partial;
    state.missed = reader.counts().missed;
    state.packets = reader.protocol().counts().packets;
    state.damaged = reader.protocol().counts().damaged;
    state.lost = reader.counts().lostPackets;
    state.skippedBytes = reader.protocol().counts().skippedBytes;
    state.unreadBytes = reader.queue().lost();
    return state;
}

void Scanner::updateHealth() {
    const auto [level, message] = sensorHealth();
    const ScannerMessage now = state();
    health().set("scanner", level, message,
                 {{"rpm", now.rpm},
                  {"beams", double(now.beams)},
                  {"revolutions", double(now.revolutions)},
                  {"damaged", double(now.damaged)},
                  {"lost", double(now.lost)}});
}

std::pair<HealthLevel, QString> Scanner::sensorHealth() {
    if (!source_.error().isEmpty())
        return {HealthLevel::Failed, source_.error()};
    if (replayed_ && source_.state() == State::Ended)
        return {HealthLevel::Warn, source_.name() +
                                       " has been played to its end; source.open {live: true} shows the "
                                       "scanner again"};
    if (replayed_)
        return {HealthLevel::Ok, "scans come from " + source_.name() +
                                     ", not from the scanner; that is read and recorded all the same"};
    if (!live_)
        return {HealthLevel::Warn, "scanner.url does not tell where a scanner is"};
    const PortThread::State port = live_->port();
    const ScanReader &reader = live_->reader();
    const auto device = known(reader.protocol().identity().model);
    const QString name = QString("%1 on %2").arg(device.value_or(reader.model().title), live_->url());
    if (port.carrier != Interface::State::Open && port.reason.isEmpty())
        return {HealthLevel::Warn, live_->url() + ": it is being opened"};
    if (port.carrier != Interface::State::Open)
        return {HealthLevel::Failed, port.reason};
    if (!live_->isFound() && live_->inVain().isEmpty())
        return {HealthLevel::Warn, "looking for a scanner on " + settings().text("scanner.url")};
    if (!live_->isFound())
        return {HealthLevel::Failed, QString("on %1 there is none of: %2; it is looked for on and on")
                                         .arg(settings().text("scanner.url"), live_->inVain().join(", "))};
    const double silent_s = monotonicNow() - reader.lastMono();
    if (const std::string &problem = reader.protocol().problem(); !problem.empty())
        return {HealthLevel::Failed, name + ": " + QString::fromStdString(problem)};
    if (reader.lastMono() == 0)
        return {HealthLevel::Warn, name + ": it has not measured a revolution yet"};
    if (silent_s > stale_s)
        return {HealthLevel::Stale, QString("%1: no revolution for %2 s").arg(name).arg(silent_s, 0, 'f', 1)};
    const scan::RevolutionAssembler::Counts counts = reader.counts();
    if (reader.period_s() == 0)
        return {HealthLevel::Ok, name + ": it measures"};
    QString text = QString("%1: %2 revolutions a minute of %3 beams, stamps to %4 ms")
                       .arg(name)
                       .arg(60 / reader.period_s(), 0, 'f', 0)
                       .arg(reader.beams())
                       .arg(double(reader.clockBound_ns()) * 1e-6, 0, 'f', 1);
    if (counts.lostPackets > 0)
        text += QString("; %1 packets were lost or damaged").arg(counts.lostPackets);
    if (counts.missed > 0)
        text += QString("; some %1 revolutions were missed").arg(counts.missed);
    if (reader.queue().lost() > 0)
        text += QString("; %1 bytes came too fast to be read").arg(reader.queue().lost());
    return {faults_.level(double(counts.lostPackets + counts.missed + reader.queue().lost())), text};
}

} // namespace hermes::scanner
