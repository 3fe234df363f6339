#include "daemons/velodynelogger/VelodyneLogger.h"

#include "common/Log.h"
#include "daemons/velodynelogger/ScanMessage.h"

#include <QFile>
#include <QThreadPool>

namespace hermes {

namespace {

constexpr int retry_ms = 2;
constexpr qint64 patience_ms = 5000;

} // namespace

VelodyneLogger::VelodyneLogger()
    : Daemon({"velodynelogger", "Velodyne logger",
              "Receives an HDL-32E or replays a capture of one, publishes its horizontal ring as scans, "
              "records pcap"})
    , feed_(recorder_, [this] {
        QMetaObject::invokeMethod(
            this, [this] { publishTurns(); }, Qt::QueuedConnection);
    }) {
    declareSettings();
    declareTopics();
    declareSourceCommands();
    declareRecordCommands();
    connect(&second_, &QTimer::timeout, this, &VelodyneLogger::tick);
    retry_.setSingleShot(true);
    connect(&retry_, &QTimer::timeout, this, &VelodyneLogger::publishTurns);
}

Result<void> VelodyneLogger::start() {
    folder_.setPath(settings().text("record.folder"));
    second_.start(1000);
    const QString pcap = settings().text("source.pcap");
    const Result<void> result =
        pcap.isEmpty() ? openLive() : openPcap(pcap, settings().number("source.speed"));
    updateHealth();
    return result;
}

void VelodyneLogger::stop() {
    second_.stop();
    retry_.stop();
    feed_.close();
    recorder_.stop();
}

LidarFeed::Options VelodyneLogger::options() {
    LidarFeed::Options options;
    const int laser = settings().integer("decode.laser");
    options.laser = laser < 0 ? velodyne::PacketDecoder::levelLaser : laser;
    options.model = velodyne::modelFromText(settings().text("decode.model").toStdString());
    options.returns = velodyne::returnsFromText(settings().text("decode.returns").toStdString());
    options.stampOffset_ns = std::int64_t(settings().number("decode.stamp_offset_s") * 1e9);
    options.dataPort = quint16(settings().integer("source.port"));
    return options;
}

Result<void> VelodyneLogger::openLive() {
    const QString address = settings().text("source.address");
    const int port = settings().integer("source.port");
    const QString name = QString("udp://%1:%2").arg(address).arg(port);
    ++generation_;
    const std::string error = feed_.openLive(address.toStdString(), quint16(port),
                                             settings().integer("source.receive_buffer_bytes"), options());
    if (!error.empty()) {
        opened(Source::None, {}, 1);
        return diskError(QString::fromStdString(error), name);
    }
    opened(Source::Live, name, 1);
    return {};
}

Result<void> VelodyneLogger::openPcap(const QString &path, double speed) {
    PcapReader probe; // a wrong name does not close what is open
    if (!probe.open(path.toStdString()))
        return diskError(QString::fromStdString(probe.error()), path);
    ++generation_;
    const auto ended = [this, generation = generation_](const std::string &failure) {
        const auto tell = [this, generation, failure] {
            if (generation != generation_) // a source that was closed meanwhile
                return;
            replayEnd_ = QString::fromStdString(failure);
            publishTurns();
        };
        QMetaObject::invokeMethod(this, tell, Qt::QueuedConnection);
    };
    const std::string error = feed_.openPcap(path.toStdString(), speed, options(), ended);
    if (!error.empty()) {
        opened(Source::None, {}, 1);
        return diskError(QString::fromStdString(error), path);
    }
    opened(Source::Replay, path, speed);
    return {};
}

void VelodyneLogger::opened(Source source, const QString &name, double speed) {
    source_ = source;
    sourceName_ = name;
    speed_ = speed;
    sourceError_.clear();
    replayEnd_.reset();
    sincePublished_.start();
    packetsAtTick_ = 0;
    packetRate_ = 0;
    sincePacket_.start();
    sinceTick_.start();
    setState(source == Source::None ? DaemonState::Ready : DaemonState::Running);
    if (source != Source::None)
        logInfo("source", "packets come from " + name);
}

Result<QJsonValue> VelodyneLogger::openSource(const Call &call) {
    const bool live = call.has("live") && call.flag("live");
    if (live == call.has("pcap"))
        return Error(ErrorCode::InvalidParams, "either live: true or pcap: FILE expected",
                     QJsonObject{{"live", "true, without pcap"}, {"pcap", "a capture file, without live"}});
    const Result<void> result = live ? openLive() : openPcap(call.text("pcap"), call.number("speed"));
    updateHealth();
    if (!result)
        return result.error();
    return sourceState();
}

void VelodyneLogger::replayEnded(QString error) {
    source_ = Source::Ended;
    sourceError_ = error;
    replayEnd_.reset();
    if (error.isEmpty())
        logInfo("source", sourceName_ + " has been played to its end");
    else
        logError("source", error);
    setState(DaemonState::Ready);
    updateHealth();
    publish("lidar", lidarState());
}

void VelodyneLogger::captureTurn(const Call &call, const Reply &reply) {
    const Result<QString> path = folder_.newFile(call.text("name"), "csv");
    if (!path || (source_ != Source::Live && source_ != Source::Replay)) {
        reply.error(path ? Error(ErrorCode::NotReady, "no source is open; source.open opens one")
                         : path.error());
        return;
    }
    feed_.captureCloud([path = *path, reply](const velodyne::Turn &turn) {
        // Not here, where receiving would wait for the disk.
        QThreadPool::globalInstance()->start(QRunnable::create([path, reply, copy = turn] {
            QFile file(path);
            const QByteArray csv = toCsv(copy);
            if (!file.open(QIODevice::WriteOnly | QIODevice::NewOnly) || file.write(csv) != csv.size() ||
                !file.flush()) {
                const QString why = file.errorString();
                if (file.isOpen())
                    file.remove();
                reply.error(diskError(path + ": cannot be written: " + why, path));
                return;
            }
            reply.result(QJsonObject{{"path", path}, {"points", double(copy.points.size())}});
        }));
    });
}

void VelodyneLogger::publishTurns() {
    // A replay without loss waits for readers who are behind, but not for one that reads no more.
    const bool patient = source_ == Source::Replay && speed_ == 0;
    for (;;) {
        if (patient && !hasRoom("scan2d") && sincePublished_.elapsed() < patience_ms) {
            retry_.start(retry_ms);
            return;
        }
        const LidarFeed::Turn turn = feed_.takeTurn();
        if (!turn)
            break;
        sincePublished_.start();
        if (hasSubscribers("scan2d"))
            publish("scan2d", toScanMessage(*turn), double(turn->begin_ns) * 1e-9);
    }
    if (replayEnd_)
        replayEnded(*replayEnd_);
}

void VelodyneLogger::tick() {
    const std::uint64_t packets = feed_.counts().packets.packets;
    if (packets != packetsAtTick_)
        sincePacket_.start();
    packetRate_ =
        double(packets - packetsAtTick_) * 1e9 / double(std::max<qint64>(1, sinceTick_.nsecsElapsed()));
    sinceTick_.start();
    packetsAtTick_ = packets;
    updateHealth();
    publish("lidar", lidarState());
}

} // namespace hermes
