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
    , m_feed(m_recorder, [this] {
        QMetaObject::invokeMethod(
            this, [this] { publishTurns(); }, Qt::QueuedConnection);
    }) {
    declareSettings();
    declareTopics();
    declareSourceCommands();
    declareRecordCommands();
    connect(&m_second, &QTimer::timeout, this, &VelodyneLogger::tick);
    m_retry.setSingleShot(true);
    connect(&m_retry, &QTimer::timeout, this, &VelodyneLogger::publishTurns);
}

Result<void> VelodyneLogger::start() {
    m_folder.setPath(settings().text("record.folder"));
    m_second.start(1000);
    const QString pcap = settings().text("source.pcap");
    const Result<void> result =
        pcap.isEmpty() ? openLive() : openPcap(pcap, settings().number("source.speed"));
    updateHealth();
    return result;
}

void VelodyneLogger::stop() {
    m_second.stop();
    m_retry.stop();
    m_feed.close();
    m_recorder.stop();
}

LidarFeed::Options VelodyneLogger::options() {
    LidarFeed::Options options;
    options.laser = settings().integer("decode.laser");
    const QString returns = settings().text("decode.returns");
    options.returns = returns == "last"   ? velodyne::Returns::Last
                      : returns == "both" ? velodyne::Returns::Both
                                          : velodyne::Returns::Strongest;
    options.stampOffset_ns = std::int64_t(settings().number("decode.stamp_offset_s") * 1e9);
    options.dataPort = quint16(settings().integer("source.port"));
    return options;
}

Result<void> VelodyneLogger::openLive() {
    const QString address = settings().text("source.address");
    const int port = settings().integer("source.port");
    const QString name = QString("udp://%1:%2").arg(address).arg(port);
    ++m_generation;
    const std::string error = m_feed.openLive(address.toStdString(), quint16(port),
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
    ++m_generation;
    const auto ended = [this, generation = m_generation](const std::string &failure) {
        const auto tell = [this, generation, failure] {
            if (generation != m_generation) // a source that was closed meanwhile
                return;
            m_replayEnd = QString::fromStdString(failure);
            publishTurns();
        };
        QMetaObject::invokeMethod(this, tell, Qt::QueuedConnection);
    };
    const std::string error = m_feed.openPcap(path.toStdString(), speed, options(), ended);
    if (!error.empty()) {
        opened(Source::None, {}, 1);
        return diskError(QString::fromStdString(error), path);
    }
    opened(Source::Replay, path, speed);
    return {};
}

void VelodyneLogger::opened(Source source, const QString &name, double speed) {
    m_source = source;
    m_sourceName = name;
    m_speed = speed;
    m_sourceError.clear();
    m_replayEnd.reset();
    m_sincePublished.start();
    m_packetsAtTick = 0;
    m_packetRate = 0;
    m_sincePacket.start();
    m_sinceTick.start();
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
    m_source = Source::Ended;
    m_sourceError = error;
    m_replayEnd.reset();
    if (error.isEmpty())
        logInfo("source", m_sourceName + " has been played to its end");
    else
        logError("source", error);
    setState(DaemonState::Ready);
    updateHealth();
    publish("lidar", lidarState());
}

void VelodyneLogger::captureTurn(const Call &call, const Reply &reply) {
    const Result<QString> path = m_folder.newFile(call.text("name"), "csv");
    if (!path || (m_source != Source::Live && m_source != Source::Replay)) {
        reply.error(path ? Error(ErrorCode::NotReady, "no source is open; source.open opens one")
                         : path.error());
        return;
    }
    m_feed.captureCloud([path = *path, reply](const velodyne::Turn &turn) {
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
    const int laser = settings().integer("decode.laser");
    // A replay without loss waits for readers who are behind, but not for one that reads no more.
    const bool patient = m_source == Source::Replay && m_speed == 0;
    for (;;) {
        if (patient && !hasRoom("scan2d") && m_sincePublished.elapsed() < patience_ms) {
            m_retry.start(retry_ms);
            return;
        }
        const LidarFeed::Turn turn = m_feed.takeTurn();
        if (!turn)
            break;
        m_sincePublished.start();
        if (hasSubscribers("scan2d"))
            publish("scan2d", toScanMessage(*turn, laser), double(turn->begin_ns) * 1e-9);
    }
    if (m_replayEnd)
        replayEnded(*m_replayEnd);
}

void VelodyneLogger::tick() {
    const std::uint64_t packets = m_feed.counts().packets.packets;
    if (packets != m_packetsAtTick)
        m_sincePacket.start();
    m_packetRate =
        double(packets - m_packetsAtTick) * 1e9 / double(std::max<qint64>(1, m_sinceTick.nsecsElapsed()));
    m_sinceTick.start();
    m_packetsAtTick = packets;
    updateHealth();
    publish("lidar", lidarState());
}

} // namespace hermes
