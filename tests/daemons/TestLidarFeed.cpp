#include "daemons/velodynelogger/LidarFeed.h"
#include "tests/support/RealData.h"
#include "tests/support/Sensor.h"

#include <QFile>
#include <QTemporaryDir>
#include <QUdpSocket>
#include <QtTest>

#include <csignal>
#include <sys/resource.h>

using namespace hermes;
using velodyne::Turn;

namespace {

/// Everything that a feed says.
class Listener {
public:
    Recorder recorder;
    std::vector<Turn> turns;
    std::atomic<int> ready{0};
    std::atomic<bool> ended{false};
    std::string error;
    LidarFeed feed{recorder, [this] { ++ready; }};

    std::string openPcap(const std::string &path, double speed) {
        return feed.openPcap(path, speed, {}, [this](const std::string &why) {
            error = why;
            ended = true;
        });
    }

    void take() {
        while (const LidarFeed::Turn turn = feed.takeTurn())
            turns.push_back(*turn);
    }
    /// Takes turns until the capture has ended.
    bool waitForEnd() {
        for (int i = 0; i < 3000 && !ended; ++i) {
            QTest::qWait(5);
            take();
        }
        take();
        return ended;
    }
};

bool operator==(const velodyne::Point &a, const velodyne::Point &b) {
    return a.stamp_ns == b.stamp_ns && a.azimuth == b.azimuth && a.range == b.range && a.x == b.x &&
           a.y == b.y && a.laser == b.laser && a.intensity == b.intensity;
}

bool same(const std::vector<Turn> &a, const std::vector<Turn> &b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Turn &s, const Turn &t) {
        return s.partial == t.partial && s.number == t.number && s.begin_ns == t.begin_ns &&
               std::equal(s.points.begin(), s.points.end(), t.points.begin(), t.points.end(),
                          [](const auto &p, const auto &q) { return p == q; });
    });
}

/// The turns of a capture, decoded in one go.
std::vector<Turn> decode(const QString &path) {
    std::vector<Turn> turns;
    velodyne::TurnAssembler assembler({}, [&](const Turn &turn) { turns.push_back(turn); });
    PcapReader reader;
    Datagram datagram;
    if (!reader.open(path.toStdString()))
        qFatal("%s", reader.error().c_str());
    while (reader.next(datagram) == PcapReader::Next::Datagram)
        assembler.feed(datagram.payload, datagram.size, datagram.stamp_ns);
    assembler.finish();
    return turns;
}

/// A capture of count packets.
QString makeCapture(const QTemporaryDir &folder, int count) {
    const QString path = folder.filePath(QStringLiteral("made.pcap"));
    const Sensor sensor;
    PcapWriter writer;
    if (!writer.open(path.toStdString()))
        qFatal("%s", writer.error().c_str());
    for (int i = 0; i < count; ++i)
        writer.write(sensorDatagram(sensor.packet(i), sensor.stamp(i)));
    return path;
}

/// Sends every datagram of a capture to a local port, at the pace at which they were received.
void sendCapture(const QString &path, quint16 port) {
    QUdpSocket socket;
    PcapReader reader;
    Datagram datagram;
    if (!reader.open(path.toStdString()))
        qFatal("%s", reader.error().c_str());
    QElapsedTimer timer;
    timer.start();
    std::int64_t first_ns = 0;
    while (reader.next(datagram) == PcapReader::Next::Datagram) {
        first_ns = first_ns ? first_ns : datagram.stamp_ns;
        while (timer.nsecsElapsed() < datagram.stamp_ns - first_ns)
            QThread::usleep(100);
        socket.writeDatagram(reinterpret_cast<const char *>(datagram.payload), qint64(datagram.size),
                             QHostAddress::LocalHost, port);
    }
}

} // namespace

class TestLidarFeed : public QObject {
    Q_OBJECT

private Q_SLOTS:
    void replayGivesWhatDirectDecodingGives_data();
    void replayGivesWhatDirectDecodingGives();
    void liveGivesWhatDirectDecodingGives();
    void fastReplayWaitsForItsReader();
    void replayKeepsItsPace();
    void cutCaptureGivesAllBeforeTheCut();
    void sourcesThatCannotBeOpened();
    void slowReadersLoseTurnsAndAreTold();
    void foreignDatagramsAreCounted();
    void allLasersOfATurn();
    void closingEndsAWaitingReplay();
    void recordsWhatComesIn();
    void recorderCountsWhatItDrops();
    void recorderReportsTheDisk();
};

void TestLidarFeed::replayGivesWhatDirectDecodingGives_data() {
    QTest::addColumn<double>("speed");
    QTest::newRow("as fast as possible") << 0.0;
    QTest::newRow("real time") << 1.0;
    QTest::newRow("threefold") << 3.0;
}

void TestLidarFeed::replayGivesWhatDirectDecodingGives() {
    QFETCH(double, speed);
    const QString path = realData(QStringLiteral("hdl32e-outdoor.pcap"));
    if (path.isEmpty())
        QSKIP("the recordings of real sensors are not here; HERMES_DATA names their folder");
    Listener listener;
    QCOMPARE(listener.openPcap(path.toStdString(), speed), std::string());
    QVERIFY(listener.waitForEnd());
    QCOMPARE(listener.error, std::string());
    QVERIFY(listener.turns.size() >= 3);
    QVERIFY(same(listener.turns, decode(path)));
    QCOMPARE(listener.feed.counts().packets.packets, std::uint64_t(500));
    QCOMPARE(listener.feed.counts().packets.lost, std::uint64_t(0));
}

void TestLidarFeed::liveGivesWhatDirectDecodingGives() {
    const QString path = realData(QStringLiteral("hdl32e-outdoor.pcap"));
    if (path.isEmpty())
        QSKIP("the recordings of real sensors are not here; HERMES_DATA names their folder");
    Listener listener;
    QCOMPARE(listener.feed.openLive("127.0.0.1", 0, 4 << 20, {}), std::string());
    sendCapture(path, listener.feed.port());
    QTRY_COMPARE(listener.feed.counts().packets.packets, std::uint64_t(500));
    const LidarFeed::Counts counts = listener.feed.counts();
    QCOMPARE(counts.packets.lost + counts.packets.outOfOrder + counts.udp.kernelDrops, std::uint64_t(0));
    listener.feed.close();
    listener.take();
    // Received today, of the hour of the recording: equal but for the hour.
    std::vector<Turn> expected = decode(path);
    const std::int64_t shift = listener.turns.at(0).begin_ns - expected.at(0).begin_ns;
    QCOMPARE(qint64(shift % (3600 * 1000000000LL)), qint64(0));
    for (Turn &turn : expected) {
        turn.begin_ns += shift;
        for (velodyne::Point &point : turn.points)
            point.stamp_ns += shift;
    }
    QVERIFY(same(listener.turns, expected));
}

void TestLidarFeed::fastReplayWaitsForItsReader() {
    QTemporaryDir folder;
    const QString path = makeCapture(folder, 6000); // 34 turns
    Listener listener;
    QCOMPARE(listener.openPcap(path.toStdString(), 0), std::string());
    QTRY_COMPARE(listener.ready.load(), 16);                   // the queue is full
    QCOMPARE(listener.feed.counts().turns, std::uint64_t(16)); // answers meanwhile
    QVERIFY(!listener.ended);
    QVERIFY(listener.waitForEnd());
    QVERIFY(same(listener.turns, decode(path)));
    QCOMPARE(listener.feed.counts().turnsDropped, std::uint64_t(0));
}

void TestLidarFeed::replayKeepsItsPace() {
    QTemporaryDir folder;
    const QString path = makeCapture(folder, 1000); // 0.553 s
    Listener listener;
    QElapsedTimer timer;
    timer.start();
    QCOMPARE(listener.openPcap(path.toStdString(), 1), std::string());
    QVERIFY(listener.waitForEnd());
    QVERIFY(timer.elapsed() > 540);
    QVERIFY(same(listener.turns, decode(path)));
}

void TestLidarFeed::cutCaptureGivesAllBeforeTheCut() {
    QTemporaryDir folder;
    const QString path = makeCapture(folder, 500);
    QVERIFY(QFile::resize(path, 24 + 300 * (16 + 42 + 1206) + 700));
    Listener listener;
    QCOMPARE(listener.openPcap(path.toStdString(), 0), std::string());
    QVERIFY(listener.waitForEnd());
    QVERIFY2(listener.error.find(path.toStdString() + ": record 301 at byte 379224 cannot be read") == 0,
             listener.error.c_str());
    QCOMPARE(listener.feed.counts().packets.packets, std::uint64_t(300));
    std::size_t points = 0;
    for (const Turn &turn : listener.turns)
        points += turn.points.size();
    QCOMPARE(points, std::size_t(300 * 12));
}

void TestLidarFeed::sourcesThatCannotBeOpened() {
    Listener listener;
    QCOMPARE(listener.openPcap("/nonexistent.pcap", 1),
             std::string("/nonexistent.pcap: cannot be opened: No such file or directory"));
    QUdpSocket other;
    QVERIFY(other.bind(QHostAddress(QHostAddress::LocalHost), 0));
    const std::string port = std::to_string(other.localPort());
    QCOMPARE(listener.feed.openLive("127.0.0.1", other.localPort(), 1 << 20, {}),
             "UDP port " + port + " of 127.0.0.1 cannot be opened: Address already in use");
    QCOMPARE(listener.feed.openLive("eth0", 0, 1 << 20, {}),
             std::string("eth0: a local IPv4 address such as 0.0.0.0 expected"));
    QCOMPARE(listener.feed.openLive("127.0.0.1", 0, 1 << 20, {}), std::string()); // and again
}

void TestLidarFeed::slowReadersLoseTurnsAndAreTold() {
    QTemporaryDir folder;
    const QString path = makeCapture(folder, 6000);
    Listener listener;
    QCOMPARE(listener.openPcap(path.toStdString(), 1000), std::string());
    QTRY_VERIFY(listener.ended.load());
    listener.take();
    const LidarFeed::Counts counts = listener.feed.counts();
    QCOMPARE(listener.turns.size(), std::size_t(16));
    QCOMPARE(counts.turnsDropped, counts.turns - 16);
    QVERIFY(counts.turns > 30);
}

void TestLidarFeed::foreignDatagramsAreCounted() {
    Listener listener;
    QCOMPARE(listener.feed.openLive("127.0.0.1", 0, 1 << 20, {}), std::string());
    QUdpSocket socket;
    const auto send = [&](const QByteArray &bytes) {
        socket.writeDatagram(bytes, QHostAddress::LocalHost, listener.feed.port());
    };
    send("hello");
    send(QByteArray(512, 'p'));
    send(QByteArray(1206, 'x'));
    send(QByteArray(5000, 'x'));
    QTRY_COMPARE(listener.feed.counts().udp.received, std::uint64_t(4));
    const LidarFeed::Counts counts = listener.feed.counts();
    QCOMPARE(counts.other, std::uint64_t(1)); // of a port that is not the sensor's
    QCOMPARE(counts.position, std::uint64_t(1));
    QCOMPARE(counts.packets.wrongFlag, std::uint64_t(1));
    QCOMPARE(counts.udp.tooLong, std::uint64_t(1));
}

void TestLidarFeed::allLasersOfATurn() {
    QTemporaryDir folder;
    const QString path = makeCapture(folder, 1000);
    Listener listener;
    std::atomic<std::size_t> points{0};
    std::atomic<int> clouds{0};
    QCOMPARE(listener.openPcap(path.toStdString(), 1), std::string());
    listener.feed.captureCloud([&](const Turn &turn) {
        points = turn.points.size();
        ++clouds;
    });
    QVERIFY(listener.waitForEnd());
    QCOMPARE(clouds.load(), 1);
    QVERIFY(points >= 2117 * 32);
}

void TestLidarFeed::closingEndsAWaitingReplay() {
    QTemporaryDir folder;
    const QString path = makeCapture(folder, 6000);
    Listener listener;
    QCOMPARE(listener.openPcap(path.toStdString(), 0), std::string());
    QTRY_COMPARE(listener.ready.load(), 16);
    listener.feed.close(); // does not hang
    QVERIFY(!listener.ended);
}

void TestLidarFeed::recordsWhatComesIn() {
    QTemporaryDir folder;
    const QString path = makeCapture(folder, 3000);
    const QString copy = folder.filePath(QStringLiteral("copy.pcap"));
    Listener listener;
    QCOMPARE(listener.recorder.start(copy.toStdString()), std::string());
    QCOMPARE(listener.openPcap(path.toStdString(), 0), std::string());
    QVERIFY(listener.waitForEnd());
    QCOMPARE(listener.recorder.stop(), std::string());
    QCOMPARE(listener.recorder.status().packets, std::uint64_t(3000));
    QCOMPARE(listener.recorder.status().dropped, std::uint64_t(0));
    QFile a(path), b(copy);
    QVERIFY(a.open(QIODevice::ReadOnly) && b.open(QIODevice::ReadOnly));
    QVERIFY(a.readAll() == b.readAll());
    QVERIFY(listener.recorder.start(copy.toStdString()).find("exists already") != std::string::npos);
    QVERIFY(!listener.recorder.isRecording());
}

void TestLidarFeed::recorderCountsWhatItDrops() {
    QTemporaryDir folder;
    const Sensor sensor;
    Recorder recorder(10 * velodyne::packetSize);
    QCOMPARE(recorder.start(folder.filePath(QStringLiteral("c.pcap")).toStdString()), std::string());
    for (int i = 0; i < 5000; ++i)
        recorder.push(sensorDatagram(sensor.packet(i), sensor.stamp(i)), false);
    QCOMPARE(recorder.stop(), std::string());
    const Recorder::Status status = recorder.status();
    QVERIFY(status.packets >= 10 && status.dropped > 0);
    QCOMPARE(status.packets + status.dropped, std::uint64_t(5000));
    QCOMPARE(std::uint64_t(QFile(QString::fromStdString(status.path)).size()), status.bytes);
}

void TestLidarFeed::recorderReportsTheDisk() {
    QTemporaryDir folder;
    const Sensor sensor;
    // A limit on the size of files stands for a full disk; without the signal it is an error of write().
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before;
    QCOMPARE(getrlimit(RLIMIT_FSIZE, &before), 0);
    const rlimit small{1000000, before.rlim_max};
    Recorder recorder;
    QCOMPARE(setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string path = folder.filePath(QStringLiteral("c.pcap")).toStdString();
    QCOMPARE(recorder.start(path), std::string());
    for (int i = 0; i < 2000; ++i)
        recorder.push(sensorDatagram(sensor.packet(i), sensor.stamp(i)), true);
    QTRY_VERIFY(!recorder.isRecording());
    setrlimit(RLIMIT_FSIZE, &before);
    const Recorder::Status status = recorder.status();
    QVERIFY2(status.error.find(path + ": cannot be written after byte ") == 0, status.error.c_str());
    QVERIFY(status.error.find("File too large") != std::string::npos);
    QVERIFY(status.packets > 0 && status.dropped > 0);
    // What is there is whole.
    PcapReader reader;
    QVERIFY(reader.open(path));
    Datagram datagram;
    std::uint64_t read = 0;
    PcapReader::Next next;
    while ((next = reader.next(datagram)) == PcapReader::Next::Datagram)
        ++read;
    QCOMPARE(next, PcapReader::Next::End);
    QCOMPARE(read, status.packets);
}

QTEST_GUILESS_MAIN(TestLidarFeed)
#include "TestLidarFeed.moc"
