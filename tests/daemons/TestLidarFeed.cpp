// Packets as they come from the network, and what becomes of those that are not the sensor's.
#include "LidarListener.h"
#include "protocol/nmea/Sentence.h"

using namespace hermes;
using velodyne::Turn;

/// A position packet of a sensor that is locked to a GPS; the sentence without checksum.
static std::vector<std::uint8_t> positionPacket(std::int64_t stamp_ns, const std::string &sentence) {
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

/// A packet of a sensor like Sensor that sees a wall 6 m away.
static std::array<std::uint8_t, velodyne::packetSize> farPacket(int number) {
    auto bytes = Sensor().packet(number);
    for (std::size_t block = 0; block < velodyne::blocksPerPacket; ++block) {
        for (std::size_t slot = 0; slot < velodyne::slotsPerBlock; ++slot) {
            const std::size_t at = block * velodyne::blockSize + 4 + 3 * slot;
            bytes[at] = 3000 & 0xFF;
            bytes[at + 1] = 3000 >> 8;
        }
    }
    return bytes;
}

/// The ranges of all points, each once.
static std::set<double> rangesOf(const std::vector<Turn> &turns) {
    std::set<double> ranges;
    for (const Turn &turn : turns) {
        for (const velodyne::Point &point : turn.points)
            ranges.insert(point.range);
    }
    return ranges;
}

/// Sends every datagram of a capture to a local port, at the pace at which they were received.
static void sendCapture(const QString &path, quint16 port) {
    QUdpSocket socket;
    PcapReader reader;
    Datagram datagram;
    if (!reader.open(path.toStdString()))
        qFatal("%s", reader.error().c_str());
    auto timer = runningTimer();
    std::int64_t first_ns = 0;
    while (reader.next(datagram) == PcapReader::Next::Datagram) {
        first_ns = first_ns ? first_ns : datagram.stamp_ns;
        while (timer.nsecsElapsed() < datagram.stamp_ns - first_ns)
            QThread::usleep(100);
        socket.writeDatagram(reinterpret_cast<const char *>(datagram.payload), qint64(datagram.size),
                             QHostAddress::LocalHost, port);
    }
}

class TestLidarFeed : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void liveGivesWhatDirectDecodingGives() {
        REAL_DATA(path, "hdl32e-outdoor.pcap");
        LidarListener listener;
        QVERIFY(listener.feed.openLive("127.0.0.1", 0, 4 << 20, {}));
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

    void sourcesThatCannotBeOpened() {
        LidarListener listener;
        QCOMPARE(listener.openPcap("/nonexistent.pcap", 1).error(),
                 std::string("/nonexistent.pcap: cannot be opened: No such file or directory"));
        QUdpSocket other;
        QVERIFY(other.bind(QHostAddress(QHostAddress::LocalHost), 0));
        const std::string port = std::to_string(other.localPort());
        QCOMPARE(listener.feed.openLive("127.0.0.1", other.localPort(), 1 << 20, {}).error(),
                 "UDP port " + port + " of 127.0.0.1 cannot be opened: Address already in use");
        QCOMPARE(listener.feed.openLive("eth0", 0, 1 << 20, {}).error(),
                 std::string("eth0: a local IPv4 address such as 0.0.0.0 expected"));
        QVERIFY(listener.feed.openLive("127.0.0.1", 0, 1 << 20, {})); // and again
    }

    void slowReadersLoseTurnsAndAreTold() {
        MadeReplay listener(6000);
        QVERIFY(listener.play(1000));
        QTRY_VERIFY(listener.ended.load());
        listener.take();
        const LidarFeed::Counts counts = listener.feed.counts();
        QCOMPARE(listener.turns.size(), std::size_t(16));
        QCOMPARE(counts.turnsDropped, counts.turns - 16);
        QVERIFY(counts.turns > 30);
    }

    /// Also when the source is live by the time it is taken; the turn that was cut off by that, too.
    void whatWaitsIsStillOfTheReplay() {
        MadeReplay listener(6000);
        listener.feed.wantClouds(LidarFeed::Thinning());
        QVERIFY(listener.play(0));
        QTRY_VERIFY(listener.ready.load() >= 16); // the queue of the clouds is full
        QVERIFY(listener.feed.openLive("127.0.0.1", 0, 1 << 20, {}));
        int turns = 0, clouds = 0;
        while (const LidarFeed::Turn turn = listener.feed.takeTurn()) {
            QVERIFY(turn->replayed);
            ++turns;
        }
        while (const LidarFeed::Turn cloud = listener.feed.takeCloud()) {
            QVERIFY(cloud->replayed);
            ++clouds;
        }
        QVERIFY2(turns >= 8 && clouds >= 8, saying("%1, %2", turns, clouds));

        QUdpSocket socket;
        for (int i = 0; i < 1000; ++i) {
            const auto bytes = Sensor().packet(i);
            socket.writeDatagram(reinterpret_cast<const char *>(bytes.data()), qint64(bytes.size()),
                                 QHostAddress::LocalHost, listener.feed.port());
            if (i % 20 == 0)
                QTest::qWait(1);
        }
        LidarFeed::Turn live;
        QTRY_VERIFY((live = listener.feed.takeTurn()));
        QVERIFY(!live->replayed);
    }

    void foreignDatagramsAreCounted() {
        LidarListener listener;
        QVERIFY(listener.feed.openLive("127.0.0.1", 0, 1 << 20, {}));
        QUdpSocket socket;
        const auto send = [&](const QByteArray &bytes) {
            socket.writeDatagram(bytes, QHostAddress::LocalHost, listener.feed.port());
        };
        send("hello");
        send(QByteArray(512, 'p'));
        send(QByteArray(1206, 'x'));
        send(QByteArray(5000, 'x'));
        QTRY_COMPARE(listener.feed.counts().udp.received, std::uint64_t(4));
        QTRY_COMPARE(listener.feed.counts().other, std::uint64_t(2)); // to a port that is not the sensor's
        const LidarFeed::Counts counts = listener.feed.counts();
        QCOMPARE(counts.gps.packets, std::uint64_t(1));
        QCOMPARE(counts.gps.wrongValue, std::uint64_t(1));
        QCOMPARE(counts.udp.tooLong, std::uint64_t(1));
    }

    void positionPacketsTellTheHour() {
        // Received on a host whose clock is 5 hours slow.
        Sensor sensor;
        QTemporaryDir folder;
        const QString path = folder.filePath(QStringLiteral("gps.pcap"));
        const std::int64_t slow_ns = 5 * 3600 * std::int64_t(1000000000);
        PcapWriter writer;
        QVERIFY(writer.open(path.toStdString()));
        for (int i = 0; i < 100; ++i) {
            if (i % 14 == 0) {
                const auto position =
                    positionPacket(sensor.stamp(i), "$GPRMC,221319,A,3707.8178,N,12139.2690,W,"
                                                    "010.3,188.2,141123,013.8,E,D");
                Datagram datagram = sensorDatagram(position, sensor.stamp(i) - slow_ns);
                datagram.destinationPort = velodyne::positionPort;
                writer.write(datagram);
            }
            writer.write(sensorDatagram(sensor.packet(i), sensor.stamp(i) - slow_ns));
        }
        QVERIFY(writer.close());
        LidarListener listener;
        QVERIFY(listener.openPcap(path.toStdString(), 0));
        QVERIFY(listener.waitForEnd());
        QVERIFY(std::abs(listener.turns.at(0).begin_ns - sensor.stamp(0)) < 1000);
        const velodyne::GpsReader::State gps = listener.feed.gps();
        QVERIFY(gps.valid && gps.utc_ns && std::abs(*gps.utc_ns - sensor.stamp(98)) < 1000);
        QVERIFY(std::abs(gps.position->latitude_deg - 37.13030) < 1e-4);
        QCOMPARE(listener.feed.counts().gps.packets, std::uint64_t(8));
        QCOMPARE(listener.feed.counts().packets.clockJumps, std::uint64_t(0));
    }

    void ofSeveralSensorsInACaptureOneIsDecoded_data() {
        const Rows<int, int, double> row("port", "only", "range"); // port: of the second
        row("to one port", 2368, 0, 5.0);
        row("to two ports", 4711, 0, 5.0);
        row("to two ports, the second", 4711, 4711, 6.0);
    }

    void ofSeveralSensorsInACaptureOneIsDecoded() {
        FETCH(int, port, int, only, double, range);
        const Sensor sensor;
        QTemporaryDir folder;
        const std::string path = folder.filePath("two.pcap").toStdString();
        PcapWriter writer;
        QVERIFY(writer.open(path));
        for (int i = 0; i < 500; ++i) {
            writer.write(sensorDatagram(sensor.packet(i), sensor.stamp(i)));
            const auto far = farPacket(i);
            Datagram second = sensorDatagram(far, sensor.stamp(i) + 1000);
            second.source += 1;
            second.destinationPort = std::uint16_t(port);
            writer.write(second);
        }
        QVERIFY(writer.close());
        LidarListener listener;
        LidarFeed::Options options;
        if (only > 0)
            options.onlyPort = std::uint16_t(only);
        const auto ended = [&listener](const Outcome<void> &) { listener.ended = true; };
        QVERIFY(listener.feed.openPcap({path}, {0}, options, ended));
        QVERIFY(listener.waitForEnd());
        QCOMPARE(rangesOf(listener.turns), std::set<double>{range});
        const LidarFeed::Counts counts = listener.feed.counts();
        QCOMPARE(counts.packets.packets, std::uint64_t(500));
        QCOMPARE(counts.otherSensors, std::uint64_t(500));
        QCOMPARE(counts.packets.lost + counts.packets.outOfOrder + counts.packets.clockJumps,
                 std::uint64_t(0));
        QCOMPARE(counts.sensors.size(), std::size_t(2));
        QCOMPARE(int(counts.decoded->port), only > 0 ? only : 2368);
    }

    void ofSeveralSensorsOnOnePortOneIsDecoded() {
        LidarListener listener;
        QVERIFY(listener.feed.openLive("0.0.0.0", 0, 4 << 20, {}));
        const Sensor sensor;
        QUdpSocket near, far;
        QVERIFY(near.bind(QHostAddress("127.0.0.1"), 0) && far.bind(QHostAddress("127.0.0.2"), 0));
        const auto send = [&](QUdpSocket &socket, const auto &bytes) {
            socket.writeDatagram(reinterpret_cast<const char *>(bytes.data()), qint64(bytes.size()),
                                 QHostAddress::LocalHost, listener.feed.port());
        };
        for (int i = 0; i < 20; ++i) {
            send(near, sensor.packet(i));
            send(far, farPacket(i));
        }
        QTRY_COMPARE(listener.feed.counts().udp.received, std::uint64_t(40));
        const std::string sensorText = "127.0.0.1:" + std::to_string(near.localPort()) + " to port " +
                                       std::to_string(listener.feed.port());
        listener.feed.close();
        listener.take();
        QCOMPARE(rangesOf(listener.turns), std::set<double>{5.0});
        QCOMPARE(listener.feed.counts().otherSensors, std::uint64_t(20));
        QCOMPARE(toText(*listener.feed.counts().decoded), sensorText);
    }
};
