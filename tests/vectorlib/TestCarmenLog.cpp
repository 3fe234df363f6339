#include "tests/support/RealData.h"

#include <vectorlib/io/CarmenLog.h>

using namespace vectorlib;

static Expected<CarmenLog> read(const QByteArray &text, bool skipDamaged = false) {
    std::istringstream in(text.toStdString());
    CarmenOptions options;
    options.skipDamaged = skipDamaged;
    return readCarmenLog(in, "a.log", options);
}

static QByteArray pose(double x, double y, double theta) {
    return QByteArray::number(x) + ' ' + QByteArray::number(y) + ' ' + QByteArray::number(theta) + ' ';
}

static QByteArray odom(double x, double y, double theta) {
    return "ODOM " + pose(x, y, theta) + "0 0 0 1.5 host 1.5\n";
}

static QByteArray flaser(const QByteArray &ranges, const QByteArray &poses, const QByteArray &stamp = "2.5") {
    return "FLASER " + QByteArray::number(ranges.split(' ').size()) + ' ' + ranges + ' ' + poses + stamp +
           " host 2.5\n";
}

/// CARMEN logs: what is read, which motion is expected, and what damaged input is answered with.
class TestCarmenLog : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void frontLaser() {
        const auto log = read("# a comment\nPARAM robot_max 3 host 0\r\n" +
                              flaser("1 2 81.9 0", pose(1, 2, 0.5) + pose(3, 4, 0.25)));
        QVERIFY2(log.ok(), log ? "" : log.error().message().c_str());
        QCOMPARE(log->scans.size(), std::size_t(1));
        const CarmenScan &scan = log->scans[0];
        QCOMPARE(scan.line, std::size_t(3));
        QCOMPARE(scan.stamp, 2.5);
        QCOMPARE(scan.laserPose.x, 1.0);
        QCOMPARE(scan.robotPose.theta, 0.25);
        QCOMPARE(scan.startAngle, -pi / 2);
        QCOMPARE(scan.angleStep, pi / 4);
        std::vector<Vector2D<double>> points;
        scan.appendPoints(points);
        QCOMPARE(points.size(), std::size_t(2)); // 81.9 and 0 are no returns
        QVERIFY((points[0] - Vector2D<double>(0, -1)).norm() < 1e-6);
        QVERIFY((points[1] - Vector2D<double>(std::sqrt(2), -std::sqrt(2))).norm() < 1e-6);
    }

    void angleSteps_data() {
        QTest::addColumn<int>("rays");
        QTest::addColumn<double>("degrees");
        for (const auto &[rays, degrees] : {std::pair(180, 1.0), {181, 1.0}, {360, 0.5}, {361, 0.5}})
            QTest::addRow("%d", rays) << rays << degrees;
    }
    void angleSteps() {
        QFETCH(int, rays);
        QByteArray ranges = "1";
        for (int i = 1; i < rays; ++i)
            ranges += " 1";
        const auto log = read(flaser(ranges, pose(0, 0, 0) + pose(0, 0, 0)));
        QTEST(log->scans[0].angleStep * 180 / pi, "degrees");
    }

    void robotLaser() {
        const auto log = read("ROBOTLASER1 0 -1.5 3.0 0.5 20 0.01 0 3 1 19.9 20 2 7 8 " + pose(1, 2, 3) +
                              pose(4, 5, 6) + "0 0 0.1 0.2 0 12.5 host 12.6\n");
        QVERIFY2(log.ok(), log ? "" : log.error().message().c_str());
        const CarmenScan &scan = log->scans[0];
        QCOMPARE(scan.startAngle, -1.5);
        QCOMPARE(scan.angleStep, 0.5);
        QCOMPARE(scan.maxRange, 20.0);
        QVERIFY(scan.isReturn(1) && !scan.isReturn(2));
        QCOMPARE(scan.laserPose.y, 2.0);
        QCOMPARE(scan.robotPose.y, 5.0);
        QCOMPARE(scan.stamp, 12.5);
    }

    void rawLogsTakeTheSecondTriple() {
        const auto log = read(flaser("1 1", pose(9, 9, 9) + pose(1, 0, 0)) + odom(1.2, 0, 0) +
                              flaser("1 1", pose(7, 7, 7) + pose(1.5, 0.5, 0.1)));
        const auto motion = log->odometryMotion(0, 1, CarmenOdometryKind::Raw);
        QVERIFY(motion.has_value());
        QVERIFY((motion->translation() - Vector2D<double>(0.5, 0.5)).norm() < 1e-12);
        QVERIFY(std::abs(motion->alpha() - 0.1) < 1e-12);
    }

    /// In corrected logs the wheels' motion runs from the pose of a scan to the last ODOM before the next
    /// one.
    void correctedLogsTakeTheOdometryBetween() {
        const QByteArray first = flaser("1 1", pose(5, 5, pi / 2) + pose(5, 5, pi / 2));
        const QByteArray wheels = odom(5, 5, pi / 2) + odom(5, 5.2, pi / 2) + odom(5, 5.4, pi / 2);
        for (const double reference : {5.5, 77.0}) { // the reference pose of the second scan must not matter
            const auto log = read(odom(0, 0, 0) + first + wheels +
                                  flaser("1 1", pose(reference, 6, 1) + pose(reference, 6, 1)));
            QVERIFY(!log->scans[0].wheelMotion);
            const auto motion = log->odometryMotion(0, 1, CarmenOdometryKind::Corrected);
            QVERIFY(motion.has_value());
            QVERIFY((motion->translation() - Vector2D<double>(0.4, 0)).norm() < 1e-5);
            QVERIFY(std::abs(motion->alpha()) < 1e-9);
        }
    }

    void gapsAreComposedAndMissingOdometryIsSaid() {
        const auto scan = [](double x) { return flaser("1 1", pose(x, 0, 0) + pose(x, 0, 0)); };
        const auto log = read(scan(0) + odom(1, 0, 0) + scan(10) + odom(10, 0, pi / 2) + scan(20) + scan(30));
        const auto two = log->odometryMotion(0, 2, CarmenOdometryKind::Corrected);
        QVERIFY(two && (two->translation() - Vector2D<double>(1, 0)).norm() < 1e-5);
        QVERIFY(std::abs(two->alpha() - pi / 2) < 1e-5);
        QVERIFY(!log->odometryMotion(2, 3, CarmenOdometryKind::Corrected));
        QVERIFY(!log->odometryMotion(0, 3, CarmenOdometryKind::Corrected));
    }

    /// The line that restarts the odometry at a scan's pose says nothing yet; a second one says that the
    /// robot stood.
    void restartAloneIsNoOdometry() {
        const QByteArray scan = flaser("1 1", pose(1, 2, 0.5) + pose(1, 2, 0.5)), restart = odom(1, 2, 0.5);
        QVERIFY(!read(scan + restart + scan)->scans[1].wheelMotion);
        const auto stood = read(scan + restart + restart + scan)->scans[1].wheelMotion;
        QVERIFY(stood && stood->translation().norm() < 1e-12);
    }

    void motionGoesOverADamagedScan() {
        const auto scan = [](double x) { return flaser("1 1", pose(x, 0, 0) + pose(x, 0, 0)); };
        const auto log = read(
            scan(0) + odom(1, 0, 0) + "FLASER 2 1 nan\n" + odom(50, 0, 0) + odom(52, 0, 0) + scan(9), true);
        QCOMPARE(log->damaged, std::size_t(1));
        QVERIFY(log->firstDamage->message().find("a.log:3:") == 0);
        const auto motion = log->odometryMotion(0, 1, CarmenOdometryKind::Corrected);
        QVERIFY(motion && (motion->translation() - Vector2D<double>(3, 0)).norm() < 1e-5);
    }

    void badInput_data() {
        const Rows<QByteArray, QByteArray, QByteArray> row("text", "place", "expected");
        const QByteArray good = flaser("1 2", pose(0, 0, 0) + pose(0, 0, 0));
        row("empty", QByteArray(), "a.log:", "at least one line FLASER");
        row("no scan", odom(0, 0, 0), "a.log:1:", "at least one line FLASER");
        row("cut in the ranges", good + "FLASER 180 1 2 3", "a.log:2:", "191 fields of FLASER");
        row("cut behind the pose", good.left(good.lastIndexOf("host")), "a.log:1:", "13 fields of FLASER");
        row("cut keyword", good + "FLA", "a.log:2:", "a CARMEN message");
        row("cut odometry", good + "ODOM 1 2 3 0", "a.log:2:", "10 fields of ODOM");
        row("not a number", flaser("1 nan", pose(0, 0, 0) + pose(0, 0, 0)),
            "a.log:1:", "range 2 of 2, a finite number");
        row("infinite pose", flaser("1 2", "0 inf 0 " + pose(0, 0, 0)), "a.log:1:", "y of a pose");
        row("pose beyond all measure", flaser("1 2", "0 1e300 0 " + pose(0, 0, 0)),
            "a.log:1:", "y of a pose below 1e7");
        row("negative range", flaser("1 -2", pose(0, 0, 0) + pose(0, 0, 0)), "a.log:1:", "range 2 of 2");
        row("huge count", "FLASER 99999999999999999999 1 2\n", "a.log:1:", "the number of ranges");
        row("count too small", "FLASER 2 1 2 3 " + pose(0, 0, 0) + pose(0, 0, 0) + "1 h 1\n",
            "a.log:1:", "13 fields of FLASER with 2 ranges");
        row("huge remissions",
            "ROBOTLASER1 0 0 1 0.5 20 0 0 2 1 2 99999 " + pose(0, 0, 0) + pose(0, 0, 0) + "0 0 0 0 0 1 h 1\n",
            "a.log:1:", "fields of ROBOTLASER1");
        for (const char *angles : {"1e308 3.0 0.5", "0 3.0 1e308", "-7 3.0 0.5"})
            row(angles,
                QByteArray("ROBOTLASER1 0 ") + angles + " 20 0 0 2 1 2 0 " + pose(0, 0, 0) + pose(0, 0, 0) +
                    "0 0 0 0 0 1 h 1\n",
                "a.log:1:", "within a turn");
        row("binary", QByteArray("FLASER\0\1\2\n", 10), "a.log:1:", "a line of text");
        row("another file", "x,y\n1,2\n", "a.log:1:", "a CARMEN message");
        row("endless line", "PARAM " + QByteArray(2 << 20, 'x'), "a.log:1:", "lines of text");
    }
    void badInput() {
        FETCH(QByteArray, text, QByteArray, place, QByteArray, expected);
        const auto log = read(text);
        QVERIFY(!log);
        const QByteArray message = QByteArray::fromStdString(log.error().message());
        QVERIFY2(message.startsWith(place), message.constData());
        QVERIFY2(message.contains(expected), message.constData());
    }
};

QTEST_APPLESS_MAIN(TestCarmenLog)
#include "TestCarmenLog.moc"
