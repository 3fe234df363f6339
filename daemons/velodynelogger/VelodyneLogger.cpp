#include "daemons/velodynelogger/VelodyneLogger.h"

#include "common/Log.h"
#include "common/files/FilesSetting.h"
#include "common/files/NamedFile.h"
#include "common/recording/DiskError.h"
#include "daemons/velodynelogger/TurnFile.h"
#include "daemons/velodynelogger/TurnMessages.h"
#include "protocol/wire/Fields.h"

#include <QThreadPool>

namespace hermes::velodynelogger {

namespace {

constexpr int retry_ms = 2;
constexpr qint64 captureTimeout_ms = 10000;

Playback::Options replayOptions(const Call &call) {
    return {call.number("speed"), call.flag("loop"), call.flag("paused")};
}

} // namespace

VelodyneLogger::VelodyneLogger()
    : Daemon({"velodynelogger", "Velodyne logger",
              "Receives an " + QString::fromStdString(velodyne::sensorNames()) +
                  " or replays a capture of one, publishes its horizontal ring as scans and thinned clouds "
                  "of all lasers, records pcap"})
    , feed_(recorder_, [this] {
        const auto wake = [this] {
            if (!retry_.isActive())
                retry_.start(0);
        };
        QMetaObject::invokeMethod(this, wake, Qt::QueuedConnection);
    }) {
    declareSettings();
    declareTopics();
    declareSourceCommands();
    declareRecordCommands();
    recording_.setCondition([this]() -> Result<void> {
        if (source_.state() == State::Live)
            return {};
        return Error(ErrorCode::NotReady,
                     "only what is received is recorded; source.open {live: true} receives");
    });
    connect(this, &Daemon::clientGone, this, [this](quint64 client) { source_.clientGone(client); });
    connect(&second_, &QTimer::timeout, this, &VelodyneLogger::tick);
    retry_.setSingleShot(true);
    connect(&retry_, &QTimer::timeout, this, &VelodyneLogger::publishTurns);
}

Result<void> VelodyneLogger::start() {
    second_.start(1000);
    const QString pcap = settings().text("source.pcap");
    recording_.open();
    Result<void> result;
    if (pcap.isEmpty())
        tryLive();
    else
        result =
            openPcap(absolutePath(pcap), {absolutePath(pcap)},
                     {settings().number("source.speed"), settings().flag("source.loop"), false}, options());
    updateHealth();
    return result;
}

void VelodyneLogger::stop() {
    second_.stop();
    retry_.stop();
    feed_.close();
    recording_.close();
}

LidarFeed::Options VelodyneLogger::options() {
    LidarFeed::Options options;
    const int laser = settings().integer("decode.laser");
    options.laser = laser < 0 ? velodyne::PacketDecoder::levelLaser : laser;
    options.model = velodyne::modelFromText(settings().text("decode.model").toStdString());
    options.returns = velodyne::returnsFromText(settings().text("decode.returns").toStdString());
    options.verticalOffsets = settings().flag("decode.vertical_offsets");
    options.stampOffset_ns = std::int64_t(settings().number("decode.stamp_offset_s") * 1e9);
    options.clock = velodyne::clockChoiceFromText(settings().text("decode.clock").toStdString());
    options.dataPort = quint16(settings().integer("source.port"));
    options.positionPort = quint16(settings().integer("source.position_port"));
    return options;
}

/// What this logger has received, other than a capture of elsewhere.
LidarFeed::Options VelodyneLogger::ofSender(LidarFeed::Options options) {
    options.sender = addressFrom(settings().text("source.sender").toStdString());
    return options;
}

LidarFeed::Options VelodyneLogger::replayedOptions(const Call &call) {
    LidarFeed::Options replayed = options();
    if (call.has("port"))
        replayed.onlyPort = quint16(call.integer("port"));
    return replayed;
}

Result<void> VelodyneLogger::openLive() {
    const QString address = settings().text("source.address");
    const int port = settings().integer("source.port");
    const QString name = QString("udp://%1:%2").arg(address).arg(port);
    source_.close();
    updateClouds();
    const auto live = feed_.openLive(address.toStdString(), quint16(port),
                                     settings().integer("source.receive_buffer_bytes"), ofSender(options()));
    if (!live) {
        if (unopened_.isEmpty())
            opened(State::None, {});
        return diskError(QString::fromStdString(live.error()), name);
    }
    opened(State::Live, name);
    return {};
}

/// A port that somebody still has, an address that comes up late: until it can be opened, or another source
/// is.
void VelodyneLogger::tryLive() {
    const Result<void> live = openLive();
    if (!live && unopened_.isEmpty())
        logError("source", live.error().message + "; it is tried again each second");
    unopened_ = live ? QString() : live.error().message;
}

Result<void> VelodyneLogger::openPcap(const QString &name, const QStringList &paths,
                                      const Playback::Options &play, const LidarFeed::Options &options,
                                      const PlayTime &begin, const Result<void> &whole) {
    std::vector<std::string> files;
    for (const QString &path : paths) {
        PcapReader probe; // a wrong name does not close what is open
        if (const auto found = probe.open(path.toStdString()); !found)
            return diskError(QString::fromStdString(found.error()), path);
        files.push_back(path.toStdString());
    }
    source_.close();
    updateClouds();
    const auto ended = source_.whenEnded([this](const Result<void> &result) {
        replayEnd_ = result;
        publishTurns();
    });
    const auto tell = [ended, name, whole](const Outcome<void> &played) {
        ended(played ? whole : diskError(QString::fromStdString(played.error()), name));
    };
    const auto replay = feed_.openPcap(files, play, options, tell, begin);
    if (!replay) {
        opened(State::None, {});
        return diskError(QString::fromStdString(replay.error()), name);
    }
    opened(State::Replay, name);
    return {};
}

void VelodyneLogger::opened(State state, const QString &name) {
    replayEnd_.reset();
    unopened_.clear();
    packetsAtTick_ = datagramsAtTick_ = othersAtTick_ = goodAtTick_ = 0;
    sinceOther_.invalidate();
    sinceGood_.invalidate();
    packetRate_ = 0;
    sincePacket_.start();
    sinceTick_.start();
    setState(state == State::None ? DaemonState::Ready : DaemonState::Running);
    if (state != State::None)
        source_.opened(state, name);
}

ReplaySource::Actions VelodyneLogger::sourceActions() {
    ReplaySource::Actions actions;
    actions.live = [this](const Call &call) -> Result<void> {
        if (call.has("port"))
            return invalidParams(
                {{"port", call.value("port"), "only of a replay; live it is the setting source.port"}},
                "port is of a replay, live it is the setting source.port");
        return openLive();
    };
    actions.pcap = [this](const Call &call) -> Result<void> {
        const QString pcap = call.text("pcap");
        const Result<QString> found = findNamedFile(pcap, namedFilesFolders(settings()));
        if (!found)
            return found.error();
        return openPcap(absolutePath(pcap), {*found}, replayOptions(call), replayedOptions(call));
    };
    actions.recording = [this](const Call &call, const StoredRecording &stored) {
        return openRecording(call, stored);
    };
    actions.duration_s = [this] { return feed_.player().duration_s(); };
    actions.records = [this] { return recording_.isActive(); };
    actions.changed = [this] { updateHealth(); };
    return actions;
}

/// The time of the replay is that of the recording, which began before its first packet.
Result<void> VelodyneLogger::openRecording(const Call &call, const StoredRecording &stored) {
    const Result<QStringList> files = stored.files();
    if (!files || files->isEmpty())
        return files ? diskError(stored.folder + ": the recording has no files", stored.folder)
                     : files.error();
    return openPcap(stored.folder, *files, replayOptions(call), ofSender(replayedOptions(call)),
                    PlayTime(std::int64_t(stored.start_s * 1e9), std::int64_t(stored.length_s * 1e9),
                             std::int64_t(call.number("delay_s") * 1e9)),
                    stored.isWhole());
}

void VelodyneLogger::closeSource() {
    source_.close();
    feed_.close();
    publishTurns();
    opened(State::None, {});
    updateHealth();
}

void VelodyneLogger::replayEnded() {
    setState(DaemonState::Ready);
    source_.end(*std::exchange(replayEnd_, std::nullopt));
    publish("lidar", [this] { return lidarState(); });
}

void VelodyneLogger::captureTurn(const Call &call, const Reply &reply) {
    const QString format = call.text("format");
    const Result<QString> path = newTurnFile(settings().text("record.folder"), call.text("name"), format);
    if (!path || !source_.isOpen()) {
        reply.error(path ? Error(ErrorCode::NotReady, "no source is open; source.open opens one")
                         : path.error());
        return;
    }
    sinceCapture_.start();
    feed_.captureTurn([path = *path, format, reply](const velodyne::Turn *turn) {
        if (!turn)
            return reply.error(Error(ErrorCode::NotReady, "no complete turn came; nothing is written"));
        // Not here, where receiving would wait for the disk.
        QThreadPool::globalInstance()->start(QRunnable::create([path, format, reply, copy = *turn] {
            const Result<void> written = writeTurn(path, copy, turnFormatFromText(format.toStdString()));
            if (!written)
                reply.error(written.error());
            else
                reply.result(asJson(CapturedTurn{path, copy.points.size()}));
        }));
    });
}

void VelodyneLogger::settingsChanged(const QStringList &paths) {
    Q_UNUSED(paths)
    cloudsWanted_ = false; // so that the thinning is told anew
    updateClouds();
}

void VelodyneLogger::updateClouds() {
    const bool wanted = hasSubscribers("cloud");
    if (wanted == cloudsWanted_)
        return;
    cloudsWanted_ = wanted;
    if (!wanted)
        return feed_.wantClouds({});
    LidarFeed::Thinning thinning;
    thinning.maximumPoints = std::uint32_t(settings().integer("cloud.max_points"));
    thinning.turnStep = std::uint32_t(settings().integer("cloud.turn_step"));
    feed_.wantClouds(thinning);
}

/// One turn, and the next after whatever else waits in the event loop: on a slow machine a message may take
/// longer to make than a turn of the sensor.
void VelodyneLogger::publishTurns() {
    updateClouds();
    if (!source_.mayShow(hasRoom("scan2d") && hasRoom("cloud"))) {
        retry_.start(retry_ms);
        return;
    }
    const LidarFeed::Turn turn = feed_.takeTurn(), cloud = feed_.takeCloud();
    if (turn || cloud) {
        if (turn)
            publish(
                "scan2d", [&] { return toScanMessage(*turn); }, double(turn->begin_ns) * 1e-9);
        if (cloud)
            publish(
                "cloud", [&] { return toCloudMessage(*cloud); }, double(cloud->begin_ns) * 1e-9);
        retry_.start(0);
    } else if (replayEnd_) {
        replayEnded();
    }
}

void VelodyneLogger::tick() {
    if (!unopened_.isEmpty())
        tryLive();
    const LidarFeed::Counts counts = feed_.counts();
    const std::uint64_t packets = counts.packets.packets, datagrams = packets + counts.other;
    const std::uint64_t good = packets - counts.packets.wrong();
    if (datagrams != datagramsAtTick_)
        sincePacket_.start();
    datagramsAtTick_ = datagrams;
    if (counts.packets.otherModel != othersAtTick_)
        sinceOther_.start();
    othersAtTick_ = counts.packets.otherModel;
    if (good != goodAtTick_)
        sinceGood_.start();
    goodAtTick_ = good;
    packetRate_ =
        double(packets - packetsAtTick_) * 1e9 / double(std::max<qint64>(1, sinceTick_.nsecsElapsed()));
    sinceTick_.start();
    packetsAtTick_ = packets;
    if (sinceCapture_.isValid() && sinceCapture_.elapsed() > captureTimeout_ms) {
        feed_.cancelCaptures();
        sinceCapture_.invalidate();
    }
    updateClouds();
    updateHealth();
    publish("lidar", [this] { return lidarState(); });
}

} // namespace hermes::velodynelogger
