// Turns of all lasers: thinned for whoever watches, whole for a file.
#include "LidarListener.h"
#include "daemons/velodynelogger/TurnText.h"

using namespace hermes;
using velodyne::Turn;

class TestLidarTurns : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void allLasersOfATurn() {
        MadeReplay listener(1000);
        std::atomic<std::size_t> points{0};
        std::atomic<int> clouds{0};
        QVERIFY(listener.play(1, false, true));
        listener.feed.captureTurn([&](const Turn *turn) {
            points = turn ? turn->points.size() : 0;
            ++clouds;
        });
        listener.feed.player().playback().setPaused(false);
        QVERIFY(listener.waitForEnd());
        QCOMPARE(clouds.load(), 1);
        QVERIFY(points >= 2117 * 32);
    }

    void aCaptureEndsWithItsSource() {
        MadeReplay listener(100); // less than a turn
        std::atomic<int> refused{0};
        const auto capture = [&refused](const Turn *turn) { refused += turn == nullptr; };
        QVERIFY(listener.play(1, false, true));
        listener.feed.captureTurn(capture);
        listener.feed.captureTurn(capture); // both are told
        listener.feed.player().playback().setPaused(false);
        QVERIFY(listener.waitForEnd());
        QCOMPARE(refused.load(), 2);
        QVERIFY(listener.feed.openLive("127.0.0.1", 0, 1 << 20, {}));
        listener.feed.captureTurn(capture);
        listener.feed.cancelCaptures();
        QCOMPARE(refused.load(), 3);
    }

    void cloudsAreThinned() {
        MadeReplay listener(6000);
        LidarFeed::Thinning thinning;
        thinning.maximumPoints = 1000;
        thinning.turnStep = 2;
        listener.feed.wantClouds(thinning);
        QVERIFY(listener.play(0));
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

    /// They are made all the same and dropped, counted; scans are not touched. Without a reader none are
    /// made.
    void nobodyReadsClouds() {
        QTemporaryDir folder;
        const QString path = makeCapture(folder, 6000);
        for (const bool wanted : {true, false}) {
            LidarListener listener;
            if (wanted)
                listener.feed.wantClouds(LidarFeed::Thinning());
            QVERIFY(listener.openPcap(path.toStdString(), 2)); // the queue holds 0.8 s of scans
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

    void turnsAreWrittenWithAllDigits() {
        Sensor sensor;
        sensor.model = &velodyne::vlp16;
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
};
