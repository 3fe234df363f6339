// A matcher that is killed while it maps: what it remembered is there again, and the drive goes on.
#include "RingDrive.h"
#include "tests/support/PatientClient.h"

using namespace hermes;
using namespace hermes::scanmatcher;

class TestKilledDrive : public QObject, RingDrive {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() { prepare(); }

    void init() {
        folder = std::make_unique<QTemporaryDir>();
        startSource(0);
        told = 0;
        startMatcher();
    }

    void cleanup() {
        client_.reset();
        process.kill();
        process.waitForFinished();
        source->shutDown();
        source.reset();
    }

    void atMostFiveSecondsAreLost_data() {
        const Rows<int> row("scans");
        std::random_device device;
        const int round = int(way.size()) / 2;
        for (int trial = 0; trial < 3; ++trial) {
            const int scans = round + 20 + int(device() % unsigned(round / 2));
            row(qPrintable(QString::number(scans)), scans);
        }
    }

    // In its second round, so that the part that is lost stood in the first one.
    void atMostFiveSecondsAreLost() {
        QFETCH(int, scans);
        const Pose2D start = way.front();
        call("pose.set", {{"x", start.x}, {"y", start.y}, {"theta", start.theta}});
        told = 0;
        QElapsedTimer timer;
        timer.start();
        std::vector<qint64> seen; // when each scan was done; milliseconds
        for (std::size_t i = 0; i < std::size_t(scans); ++i) {
            drive(i, i + 1);
            seen.push_back(timer.elapsed());
            const qint64 pace = driveMs * qint64(i + 1) / scans;
            QTRY_VERIFY_WITH_TIMEOUT(timer.elapsed() >= pace, driveMs);
        }
        const QJsonObject state = call("matcher.state");
        const qint64 killed = timer.elapsed();
        process.kill();
        QVERIFY(process.waitForFinished());
        const auto early =
            std::count_if(seen.begin(), seen.end(), [&](qint64 t) { return t < killed - 5000; });
        QVERIFY(early > 0);
        const Pose2D last = poseOf(poses.rbegin()->second);

        startMatcher();
        timer.restart();
        const QJsonObject loaded = call("map.load", {{"path", "drive.journal"}});
        qInfo("killed after %.1f s, %zu scans, %d key scans, %d loops: %d scans, %d key scans, %d loops "
              "again in "
              "%lld ms; %lld needed",
              1e-3 * double(killed), seen.size(), state["key_scans"].toInt(), state["closures"].toInt(),
              loaded["scans"].toInt(), loaded["key_scans"].toInt(), loaded["closures"].toInt(),
              timer.elapsed(), qint64(early));
        QVERIFY(loaded["scans"].toInt() >= int(early) && loaded["scans"].toInt() <= int(seen.size()));
        QVERIFY(loaded["key_scans"].toInt() > 0 && loaded["segments"].toInt() > 0);
        QTRY_COMPARE(graphPoses.size(), loaded["key_scans"].toInt());
        QCOMPARE(call("map.get")["size"].toInt(), loaded["segments"].toInt());

        // It is told where it stands, and goes on from there.
        call("pose.set", {{"x", last.x}, {"y", last.y}, {"theta", last.theta}});
        told = seen.size() - 1;
        drive(seen.size() - 1, way.size());
        waitForCorrector();
        const QJsonObject after = call("matcher.state");
        qInfo("%d key scans, %d loops, %d corrections, key scans %.3f m off", after["key_scans"].toInt(),
              after["closures"].toInt(), after["corrections"].toInt(), farthestFromTheWay());
        QVERIFY(after["closures"].toInt() > loaded["closures"].toInt() + 20);
        QVERIFY(graphPoses.size() > loaded["key_scans"].toInt());
        QVERIFY(farthestFromTheWay() < 0.5); // a part that is laid to a room that is alike is metres off
        QTRY_VERIFY_WITH_TIMEOUT(QFile::exists(folder->filePath("drive-2.journal")), 10000 * slowness);
    }

    // It was carried away meanwhile, in a room of which it knows all.
    void thePlaceIsFoundAgain() {
        const auto show = [&](const Pose2D &pose, int number) {
            const QJsonObject scan = roomScan(pose, 1 + 0.1 * number);
            source->publish("scan2d", scan, scan["stamp"].toDouble());
            QTRY_VERIFY_WITH_TIMEOUT(poses.count(scan["turn"].toInt()) > 0, 20000);
        };
        for (int i = 0; i < 60; ++i)
            show(onTheWay(i), i);
        const auto written = [this] { return healthItem("journal")["values"].toObject()["scans"].toInt(); };
        QTRY_VERIFY_WITH_TIMEOUT(written() > 10, 20000 * slowness);
        const QJsonObject loaded = call("map.load", {{"path", "drive.journal"}});
        QVERIFY(loaded["scans"].toInt() > 10);
        QVERIFY(healthItem("tracking")["message"].toString().contains("sought"));
        const Pose2D elsewhere{2.5, -1.5, 2.5};
        poses.clear();
        for (int i = 100; i < 110; ++i)
            show(elsewhere, i);
        const Pose2D found = onTheWay(0).inverse() * elsewhere; // the map's frame is that of the first scan
        QTRY_VERIFY(!poses.empty() && distance(poseOf(poses.rbegin()->second), found) < 0.05);
        QVERIFY(!healthItem("tracking")["message"].toString().contains("sought"));
        // A second search, a metre on, confirms the place: then the map grows again.
        const auto grows = [&] {
            return call("matcher.state")["key_scans"].toInt() > loaded["key_scans"].toInt();
        };
        QElapsedTimer timer;
        timer.start();
        for (int i = 110; !grows() && timer.elapsed() < 20000; ++i)
            show(elsewhere * Pose2D{std::min(1.5, 0.1 * (i - 109)), 0, 0}, i);
        QVERIFY(grows());
        QCOMPARE(call("map.load", {{"path", "no.journal"}})["failed"].toString().isEmpty(), false);
    }

private:
    void startMatcher() {
        const QString address = QString("127.0.0.1:%1").arg(sourcePort);
        process.setProcessChannelMode(QProcess::MergedChannels);
        process.start(qEnvironmentVariable("HERMES_BIN") + "/hermes-scanmatcher",
                      {"--listen", "tcp://127.0.0.1:0", "--set", "map.folder=" + folder->path(), "--set",
                       "map.journal=drive.journal", "--set", "source.address=" + address, "--set",
                       "odometry.address=" + address});
        QVERIFY(process.waitForStarted());
        QString log;
        const QRegularExpression listens("127.0.0.1:(\\d+),");
        QTRY_VERIFY((log += process.readAll()).contains(listens));
        client_ = std::make_unique<ConnectedClient>(asOwner("127.0.0.1:" + listens.match(log).captured(1)));
        QTRY_VERIFY(source->hasSubscribers("odometry") && source->hasSubscribers("scan2d"));
        listen();
    }

    static constexpr int driveMs = 7000; // until it is killed: more than the five seconds

    QProcess process;
};

QTEST_GUILESS_MAIN(TestKilledDrive)
#include "TestKilledDrive.moc"
