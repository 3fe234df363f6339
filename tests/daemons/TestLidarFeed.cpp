#include "daemons/velodynelogger/LidarFeed.h"
#include "tests/support/RealData.h"
#include "tests/support/Sensor.h"

#include "daemons/velodynelogger/TurnText.h"
#include "protocol/nmea/Sentence.h"

#include <QFile>
#include <QProcess>
#include <QTemporaryDir>
#include <QUdpSocket>
#include <QtTest>

using namespace hermes;
using velodyne::Turn;

namespace {

/// Everything that a feed says.
class Listener {
public:
    Recorder recorder;
    std::vector<Turn> turns;
    std::vector<Turn> clouds;
    std::atomic<int> ready{0};
    std::atomic<bool> ended{false};
    std::string error;
    LidarFeed feed{recorder, [this] { ++ready; }};

    std::string openPcap(const std::string &path, double speed, bool loop = false, bool paused = false) {
        return feed.openPcap({path}, {speed, loop, paused}, {}, [this](const std::string &why) {
            error = why;
            ended = true;
        });
    }

    void take() {
        while (const LidarFeed::Turn turn = feed.takeTurn())
            turns.push_back(*turn);
        while (const LidarFeed::Turn cloud = feed.takeCloud())
            clouds.push_back(*cloud);
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

/// A position packet of a sensor that is locked to a GPS; the sentence without checksum.
std::vector<std::uint8_t> positionPacket(std::int64_t stamp_ns, const std::string &sentence) {
    std::vector<std::uint8_t> bytes(velodyne::positionPacketSize);
    const auto stamp_us = std::uint32_t(stamp_ns / 1000 % velodyne::stampPeriod_us);
    for (int i = 0; i < 4; ++i)
        bytes[0xC6 + std::size_t(i)] = std::uint8_t(stamp_us >> 8 * i);
    bytes[0xCA] = 2;
    const QByteArray text =
        QByteArray::fromStdString(sentence) + '*' +
        QByteArray::number(nmea::checksum(sentence.substr(1)), 16).rightJustified(2, '0').toUpper() + "\r\n";
    std::copy(text.begin(), text.end(), bytes.begin() + 0xCE);
    return bytes;
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
    void aCaptureEndsWithItsSource();
    void cloudsAreThinned();
    void nobodyReadsClouds();
    void positionPacketsTellTheHour();
    void replayLoops();
    void replaySeeks_data();
    void replaySeeks();
    void replayPauses();
    void severalFilesAreOneReplay();
    void aRecordingBeginsBeforeItsFirstPacket();
    void clockStepsAreNotWaitedFor();
    void turnsAreWrittenWithAllDigits();
    void closingEndsAWaitingReplay();
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
    QTRY_COMPARE(listener.feed.counts().packets.wrongFlag, std::uint64_t(1)); // the last that is decoded
    const LidarFeed::Counts counts = listener.feed.counts();
    QCOMPARE(counts.other, std::uint64_t(1)); // of a port that is not the sensor's
    QCOMPARE(counts.gps.packets, std::uint64_t(1));
    QCOMPARE(counts.gps.wrongValue, std::uint64_t(1));
    QCOMPARE(counts.packets.wrongFlag, std::uint64_t(1));
    QCOMPARE(counts.udp.tooLong, std::uint64_t(1));
}

void TestLidarFeed::allLasersOfATurn() {
    QTemporaryDir folder;
    const QString path = makeCapture(folder, 1000);
    Listener listener;
    std::atomic<std::size_t> points{0};
    std::atomic<int> clouds{0};
    QCOMPARE(listener.openPcap(path.toStdString(), 1, false, true), std::string());
    listener.feed.captureTurn([&](const Turn *turn) {
        points = turn ? turn->points.size() : 0;
        ++clouds;
    });
    listener.feed.player().setPaused(false);
    QVERIFY(listener.waitForEnd());
    QCOMPARE(clouds.load(), 1);
    QVERIFY(points >= 2117 * 32);
}

void TestLidarFeed::aCaptureEndsWithItsSource() {
    QTemporaryDir folder;
    const QString path = makeCapture(folder, 100); // less than a turn
    Listener listener;
    std::atomic<int> refused{0};
    const auto capture = [&refused](const Turn *turn) { refused += turn == nullptr; };
    QCOMPARE(listener.openPcap(path.toStdString(), 1, false, true), std::string());
    listener.feed.captureTurn(capture);
    listener.feed.captureTurn(capture); // both are told
    listener.feed.player().setPaused(false);
    QVERIFY(listener.waitForEnd());
    QCOMPARE(refused.load(), 2);
    QCOMPARE(listener.feed.openLive("127.0.0.1", 0, 1 << 20, {}), std::string());
    listener.feed.captureTurn(capture);
    listener.feed.cancelCaptures();
    QCOMPARE(refused.load(), 3);
}

void TestLidarFeed::cloudsAreThinned() {
    QTemporaryDir folder;
    const QString path = makeCapture(folder, 6000);
    Listener listener;
    LidarFeed::Thinning thinning;
    thinning.maximumPoints = 1000;
    thinning.turnStep = 2;
    listener.feed.wantClouds(thinning);
    QCOMPARE(listener.openPcap(path.toStdString(), 0), std::string());
    QVERIFY(listener.waitForEnd());
    QCOMPARE(listener.turns.size(), std::size_t(35));
    QCOMPARE(listener.clouds.size(), std::size_t(18));
    QCOMPARE(listener.feed.counts().cloudsDropped, std::uint64_t(0));
    for (std::size_t i = 0; i < listener.clouds.size(); ++i) {
        const Turn &cloud = listener.clouds[i], &ring = listener.turns[2 * i];
        QCOMPARE(cloud.number, ring.number);
        QCOMPARE(cloud.begin_ns, ring.begin_ns);
        QVERIFY(cloud.points.size() <= 1000 && (cloud.partial || cloud.points.size() > 900));
        QVERIFY(cloud.points.size() % 32 == 0 && cloud.laser == velodyne::PacketDecoder::allLasers);
    }
}

/// They are made all the same and dropped, counted; scans are not touched. Without a reader none are made.
void TestLidarFeed::nobodyReadsClouds() {
    QTemporaryDir folder;
    const QString path = makeCapture(folder, 6000);
    for (const bool wanted : {true, false}) {
        Listener listener;
        if (wanted)
            listener.feed.wantClouds(LidarFeed::Thinning());
        QCOMPARE(listener.openPcap(path.toStdString(), 2), std::string()); // the queue holds 0.8 s of scans
        for (int i = 0; i < 3000 && !listener.ended; ++i) {
            QTest::qWait(5);
            while (const LidarFeed::Turn turn = listener.feed.takeTurn())
                listener.turns.push_back(*turn);
        }
        listener.take();
        QCOMPARE(listener.turns.size(), std::size_t(35));
        QCOMPARE(listener.feed.counts().cloudsDropped, std::uint64_t(wanted ? 27 : 0));
        QCOMPARE(listener.clouds.size(), std::size_t(wanted ? 8 : 0));
    }
}

void TestLidarFeed::positionPacketsTellTheHour() {
    // Received on a host whose clock is 5 hours slow.
    Sensor sensor;
    QTemporaryDir folder;
    const QString path = folder.filePath(QStringLiteral("gps.pcap"));
    const std::int64_t slow_ns = 5 * 3600 * std::int64_t(1000000000);
    PcapWriter writer;
    QVERIFY(writer.open(path.toStdString()));
    for (int i = 0; i < 100; ++i) {
        if (i % 14 == 0) {
            const auto position = positionPacket(sensor.stamp(i), "$GPRMC,221319,A,3707.8178,N,12139.2690,W,"
                                                                  "010.3,188.2,141123,013.8,E,D");
            Datagram datagram = sensorDatagram(position, sensor.stamp(i) - slow_ns);
            datagram.destinationPort = velodyne::positionPort;
            writer.write(datagram);
        }
        writer.write(sensorDatagram(sensor.packet(i), sensor.stamp(i) - slow_ns));
    }
    QVERIFY(writer.close());
    Listener listener;
    QCOMPARE(listener.openPcap(path.toStdString(), 0), std::string());
    QVERIFY(listener.waitForEnd());
    QVERIFY(std::abs(listener.turns.at(0).begin_ns - sensor.stamp(0)) < 1000);
    const velodyne::GpsReader::State gps = listener.feed.gps();
    QVERIFY(gps.valid && gps.utc_ns && std::abs(*gps.utc_ns - sensor.stamp(98)) < 1000);
    QVERIFY(std::abs(gps.position->latitude_deg - 37.13030) < 1e-4);
    QCOMPARE(listener.feed.counts().gps.packets, std::uint64_t(8));
    QCOMPARE(listener.feed.counts().packets.clockJumps, std::uint64_t(0));
}

void TestLidarFeed::replayLoops() {
    QTemporaryDir folder;
    const QString path = makeCapture(folder, 500);
    Listener listener;
    QCOMPARE(listener.openPcap(path.toStdString(), 0, true), std::string());
    QTRY_VERIFY((listener.take(), listener.turns.size() >= 12));
    QVERIFY(!listener.ended);
    listener.feed.close();
    // Each time the same four turns, numbered on; nothing counts as lost.
    for (std::size_t i = 4; i < 12; ++i) {
        QCOMPARE(listener.turns[i].number, std::uint64_t(i));
        QCOMPARE(listener.turns[i].begin_ns, listener.turns[i % 4].begin_ns);
        QCOMPARE(listener.turns[i].points.size(), listener.turns[i % 4].points.size());
    }
    const velodyne::PacketCounts counts = listener.feed.counts().packets;
    QCOMPARE(counts.lost + counts.outOfOrder + counts.clockJumps, std::uint64_t(0));
    QVERIFY(listener.feed.player().status().loops >= 2);
    // A file that is cut is played to the cut, once.
    QVERIFY(QFile::resize(path, 24 + 300 * (16 + 42 + 1206) + 700));
    Listener cut;
    QCOMPARE(cut.openPcap(path.toStdString(), 0, true), std::string());
    QVERIFY(cut.waitForEnd());
    QVERIFY(!cut.error.empty());
    QCOMPARE(cut.feed.counts().packets.packets, std::uint64_t(300));
}

void TestLidarFeed::replaySeeks_data() {
    QTest::addColumn<double>("target_s");
    QTest::addColumn<bool>("pcapng");
    QTest::addColumn<int>("first"); // packet played after it
    QTest::newRow("to the beginning") << 0.0 << false << 0;
    QTest::newRow("between two packets") << 0.0100 << false << 19;
    QTest::newRow("behind the first mark") << 3.0 << false << 5426;
    QTest::newRow("the last packet") << 11999 * 552.96e-6 << false << 11999;
    QTest::newRow("pcapng") << 3.0 << true << 5426;
}

/// Paused, so that nothing but the target is played after the seek; from the front and from behind.
void TestLidarFeed::replaySeeks() {
    QFETCH(double, target_s);
    QFETCH(bool, pcapng);
    QFETCH(int, first);
    QTemporaryDir folder;
    QString path = makeCapture(folder, 12000);
    if (pcapng) {
        path = folder.filePath(QStringLiteral("made.pcapng"));
        if (QProcess::execute(QStringLiteral("editcap"),
                              {QStringLiteral("-F"), QStringLiteral("pcapng"),
                               folder.filePath(QStringLiteral("made.pcap")), path}) != 0)
            QSKIP("editcap is not installed");
    }
    for (const double from_s : {0.5, 5.0}) { // far from the end, at which nothing is left to seek
        std::mutex mutex;
        std::vector<std::int64_t> stamps;
        std::atomic<int> jumps{0};
        PcapPlayer player(
            [&](const Datagram &datagram) {
                const std::lock_guard<std::mutex> lock(mutex);
                stamps.push_back(datagram.stamp_ns);
            },
            [&] { ++jumps; }, [](const std::string &) {});
        const auto played = [&] {
            const std::lock_guard<std::mutex> lock(mutex);
            return stamps;
        };
        QCOMPARE(player.start({path.toStdString()}, {1, false}), std::string());
        QTRY_VERIFY(player.status().duration_s.has_value());
        QVERIFY(std::abs(*player.status().duration_s - 11999 * 552.96e-6) < 1e-5);
        player.seek(from_s);
        QTRY_VERIFY(jumps == 1 && !played().empty() && played().back() - Sensor().stamp(0) >= from_s * 1e9);
        player.setPaused(true);
        player.seek(target_s);
        QTRY_COMPARE(jumps.load(), 2);
        const std::size_t before = played().size();
        player.setPaused(false);
        QTRY_VERIFY(played().size() > before);
        QCOMPARE(played()[before], Sensor().stamp(first));
        QVERIFY(player.status().position_s >= first * 552.96e-6 - 1e-6);
        player.stop();
    }
}

void TestLidarFeed::replayPauses() {
    QTemporaryDir folder;
    const QString path = makeCapture(folder, 3000); // 1.659 s
    Listener listener;
    QCOMPARE(listener.openPcap(path.toStdString(), 1), std::string());
    QTRY_VERIFY(listener.feed.counts().packets.packets > 100);
    listener.feed.player().setPaused(true);
    std::uint64_t packets = 0; // one may be on its way
    QTRY_VERIFY(packets == std::exchange(packets, listener.feed.counts().packets.packets));
    QElapsedTimer timer;
    timer.start();
    while (timer.elapsed() < 700) // in which 1200 packets would have been played
        QTest::qWait(10);
    QCOMPARE(listener.feed.counts().packets.packets, packets);
    QVERIFY(listener.feed.player().status().paused && !listener.ended);
    listener.feed.player().setPaused(false);
    QVERIFY(listener.waitForEnd()); // and does not hurry to catch up: the rest takes its time
    QVERIFY(timer.elapsed() > 700 + qint64(double(3000 - packets) * 0.553) - 20);
    QVERIFY(same(listener.turns, decode(path)));
}

/// With a mark in each of them, found again by a seek back.
void TestLidarFeed::severalFilesAreOneReplay() {
    QTemporaryDir folder;
    const QString whole = makeCapture(folder, 9000);
    const Sensor sensor;
    std::vector<std::string> paths;
    for (int begin = 0; begin < 9000; begin += 3000) {
        paths.push_back(folder.filePath(QString::number(begin)).toStdString());
        PcapWriter writer;
        QVERIFY(writer.open(paths.back()));
        for (int i = begin; i < begin + 3000; ++i)
            writer.write(sensorDatagram(sensor.packet(i), sensor.stamp(i)));
        QVERIFY(writer.close());
    }
    Listener listener;
    const auto ended = [&](const std::string &why) {
        listener.error = why;
        listener.ended = true;
    };
    QCOMPARE(listener.feed.openPcap(paths, {0}, {}, ended), std::string());
    QVERIFY(listener.waitForEnd());
    QCOMPARE(listener.error, std::string());
    QVERIFY(same(listener.turns, decode(whole)));

    std::mutex mutex;
    std::int64_t last = 0;
    PcapPlayer player(
        [&](const Datagram &datagram) {
            const std::lock_guard<std::mutex> lock(mutex);
            last = datagram.stamp_ns;
        },
        [] {}, [](const std::string &) {});
    const auto at = [&](int packet) {
        const std::lock_guard<std::mutex> lock(mutex);
        return last >= sensor.stamp(packet) && last < sensor.stamp(packet + 2000);
    };
    QCOMPARE(player.start(paths, {1}), std::string());
    QTRY_VERIFY(player.status().duration_s.has_value());
    QVERIFY(std::abs(*player.status().duration_s - 8999 * 552.96e-6) < 1e-5);
    for (const int packet : {7000, 2000, 4000}) {
        player.seek(packet * 552.96e-6);
        QTRY_VERIFY(at(packet));
    }
    QVERIFY(QFile::remove(QString::fromStdString(paths[2])));
    listener.ended = false;
    QCOMPARE(listener.feed.openPcap(paths, {0}, {}, ended), std::string());
    QVERIFY(listener.waitForEnd());
    QVERIFY2(listener.error.find("cannot be opened") != std::string::npos, listener.error.c_str());
    QCOMPARE(listener.feed.counts().packets.packets, std::uint64_t(6000));
}

/// It began 100 s before, which is no jump of the clock, and is played 0.3 s after others.
void TestLidarFeed::aRecordingBeginsBeforeItsFirstPacket() {
    QTemporaryDir folder;
    const QString path = makeCapture(folder, 500); // 0.276 s
    const std::int64_t begin_ns = Sensor().stamp(0) - 100000000000;
    Listener listener;
    PcapPlayer::Options play;
    play.speed = 100;
    play.paused = true;
    play.begin = PlayTime(begin_ns, 101000000000, 300000000);
    QCOMPARE(listener.feed.openPcap({path.toStdString()}, play, {},
                                    [&](const std::string &) { listener.ended = true; }),
             std::string());
    QTRY_VERIFY(listener.feed.player().status().duration_s.has_value());
    QVERIFY(std::abs(*listener.feed.player().status().duration_s - 100.3 - 499 * 552.96e-6) < 1e-5);
    QElapsedTimer timer;
    timer.start();
    listener.feed.player().setPaused(false);
    QVERIFY(listener.waitForEnd());
    QVERIFY(timer.elapsed() >= 1003);
    QCOMPARE(listener.feed.counts().packets.packets, std::uint64_t(500));
}

/// The clock of the recording host was set back by an hour, then forward by a day.
void TestLidarFeed::clockStepsAreNotWaitedFor() {
    QTemporaryDir folder;
    const QString path = folder.filePath(QStringLiteral("steps.pcap"));
    const Sensor sensor;
    PcapWriter writer;
    QVERIFY(writer.open(path.toStdString()));
    for (int i = 0; i < 300; ++i) {
        const std::int64_t off_s = i < 100 ? 0 : i < 200 ? -3600 : 86400;
        writer.write(sensorDatagram(sensor.packet(i), sensor.stamp(i) + off_s * 1000000000));
    }
    QVERIFY(writer.close());
    Listener listener;
    QElapsedTimer timer;
    timer.start();
    QCOMPARE(listener.openPcap(path.toStdString(), 1), std::string());
    QVERIFY(listener.waitForEnd());
    QVERIFY(timer.elapsed() > 160 - 20); // 297 steps of 0.553 ms
    QCOMPARE(listener.feed.counts().packets.packets, std::uint64_t(300));
    QCOMPARE(listener.feed.counts().packets.clockJumps, std::uint64_t(2));
    QCOMPARE(listener.feed.counts().packets.lost, std::uint64_t(0));
}

void TestLidarFeed::turnsAreWrittenWithAllDigits() {
    Sensor sensor;
    sensor.model = &velodyne::vlp16();
    velodyne::TurnAssembler::Options all;
    all.laser = velodyne::PacketDecoder::allLasers;
    std::vector<Turn> turns;
    velodyne::TurnAssembler assembler(all, [&](const Turn &turn) { turns.push_back(turn); });
    const auto bytes = sensor.packet(0);
    assembler.feed(bytes.data(), bytes.size(), sensor.stamp(0));
    assembler.finish();
    const Turn &turn = turns.at(0);
    std::string csv = turnHeader(turn, TurnFormat::Csv);
    for (const velodyne::Point &point : turn.points)
        appendPoint(csv, turn, point, TurnFormat::Csv);
    const QList<QByteArray> lines = QByteArray::fromStdString(csv).split('\n');
    QCOMPARE(lines.size(), int(turn.points.size()) + 2);
    for (std::size_t i = 0; i < turn.points.size(); ++i) {
        const QList<QByteArray> fields = lines[int(i) + 1].split(',');
        QCOMPARE(fields.size(), 9);
        QVERIFY(fields[3].toDouble() == turn.points[i].azimuth &&
                fields[4].toDouble() == turn.points[i].range);
        QVERIFY(fields[6].toDouble() == turn.points[i].x && fields[7].toDouble() == turn.points[i].y &&
                fields[8].toDouble() == turn.points[i].z);
        QCOMPARE(fields[1].mid(0, 10) + fields[1].mid(11),
                 QByteArray::number(qint64(turn.points[i].stamp_ns)));
    }
    for (const TurnFormat format : {TurnFormat::Pcd, TurnFormat::Ply}) {
        std::string line;
        appendPoint(line, turn, turn.points[5], format);
        const QList<QByteArray> fields = QByteArray::fromStdString(line).simplified().split(' ');
        QCOMPARE(fields.size(), 6);
        QVERIFY(fields[0].toFloat() == float(turn.points[5].x));
        QCOMPARE(fields[4], QByteArray("10")); // laser 5 looks 5 degrees up: ring 10
    }
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

QTEST_GUILESS_MAIN(TestLidarFeed)
#include "TestLidarFeed.moc"
