#include <vectorlib/io/CarmenDrive.h>

using namespace vectorlib;

Q_DECLARE_METATYPE(vectorlib::Pose2D)

static Expected<CarmenLog> read(const QByteArray &text, CarmenOptions options) {
    std::istringstream in(text.toStdString());
    return readCarmenLog(in, "a.log", options);
}
static Expected<CarmenLog> read(const QByteArray &text, bool skipDamaged = false) {
    CarmenOptions options;
    options.skipDamaged = skipDamaged;
    return read(text, options);
}

static QByteArray pose(double x, double y, double theta) {
    return QByteArray::number(x) + ' ' + QByteArray::number(y) + ' ' + QByteArray::number(theta) + ' ';
}

static QByteArray odom(double x, double y, double theta) {
    return "ODOM " + pose(x, y, theta) + "0 0 0 1.5 host 1.5\n";
}

/// As many ranges of one value.
static QByteArray alike(int rays, const QByteArray &range = "1") {
    return QByteArrayList(QVector<QByteArray>(rays, range).toList()).join(' ');
}

static QByteArray flaser(const QByteArray &ranges, const QByteArray &poses, const QByteArray &stamp = "2.5") {
    return "FLASER " + QByteArray::number(ranges.split(' ').size()) + ' ' + ranges + ' ' + poses + stamp +
           " host 2.5\n";
}

static QByteArray robotScan(const QByteArray &ranges, const QByteArray &poses,
                            const QByteArray &step = "0.01", const QByteArray &maxRange = "30") {
    return "ROBOTLASER1 0 -1.5 3.0 " + step + ' ' + maxRange + " 0.01 0 " +
           QByteArray::number(ranges.split(' ').size()) + ' ' + ranges + " 0 " + poses +
           "0 0 0 0 0 2.5 host 2.5\n";
}

static int returns(const CarmenScan &scan) {
    int count = 0;
    for (std::size_t i = 0; i < scan.ranges.size(); ++i)
        count += scan.isReturn(i);
    return count;
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
        const Rows<int, QByteArray, double, double> row("rays", "parameters", "step", "start");
        for (const int rays : {180, 181})
            row(qPrintable(QString::number(rays)), rays, "", 1, -90);
        for (const int rays : {360, 361})
            row(qPrintable(QString::number(rays)), rays, "", 0.5, -90);
        for (const int rays : {720, 721})
            row(qPrintable(QString::number(rays)), rays, "", 0.25, -90);
        row("541", 541, "", 0.5, -135);
        row("1081", 1081, "", 0.25, -135);
        row("682", 682, "", 360.0 / 1024, -682 * 180.0 / 1024);
        row("no known scanner", 91, "", 2, -90);
        row("field of view", 91, "PARAM laser_front_laser_fov 270 host 0\n", 3, -135);
        row("another field of view", 181, "PARAM laser_front_laser_fov 90 host 0\n", 0.5, -45);
        row("resolution", 401, "PARAM laser_front_laser_resolution 0.25 host 0\n", 0.25, -50);
        row("another spelling", 91, "PARAM laser_frontlaser_resolution 1\n", 1, -45);
        row("of a second laser", 181, "PARAM laser_rear_laser_fov 90 host 0\n", 1, -90);
        row("resolution of another scan", 541, "PARAM laser_front_laser_resolution 1.0 host 0\n", 0.5, -135);
    }
    void angleSteps() {
        FETCH(int, rays, QByteArray, parameters);
        const QByteArray scan = flaser(alike(rays), pose(0, 0, 0) + pose(0, 0, 0));
        const auto log = read(parameters + scan);
        QTEST(log->scans[0].angleStep * 180 / pi, "step");
        QTEST(log->scans[0].startAngle * 180 / pi, "start");
        QCOMPARE(log->assumedRays, std::size_t(rays == 91 && parameters.isEmpty() ? 91 : 0));
        for (const QByteArray &text :
             {scan, robotScan(alike(rays), pose(0, 0, 0) + pose(0, 0, 0), "0.001")}) {
            const CarmenScan told = read(parameters + text, {false, {}, 120.0, 5.0})->scans[0];
            QCOMPARE(told.startAngle * 180 / pi, -60.0);
            QVERIFY(std::abs(told.angleStep * (rays / 2 * 2) * 180 / pi - 120) < 1e-9);
            QCOMPARE(told.maxRange, 5.0);
        }
    }

    void longestRange_data() {
        const Rows<QByteArray, double> row("text", "maxRange");
        const QByteArray scan = flaser("1 2 3", pose(0, 0, 0) + pose(0, 0, 0));
        row("told", "PARAM robot_front_laser_max 8.1 host 0\n" + scan, 8.1);
        row("told later", scan + "PARAM robot_front_laser_max 8.1 host 0\n", 8.1);
        row("of another laser", "PARAM robot_rear_laser_max 8.1 host 0\n" + scan, 1000);
        row("by the message",
            "PARAM robot_front_laser_max 8.1\n" +
                robotScan("1 2 3", pose(0, 0, 0) + pose(0, 0, 0), "0.01", "20"),
            20);
    }
    void longestRange() {
        QFETCH(QByteArray, text);
        QTEST(std::min(1000.0, read(text)->scans[0].maxRange), "maxRange");
    }

    void noReturnIsNoNumberOfMetres_data() {
        rowsOf<QByteArray>("range", {"inf", "+inf", "-Infinity", "NaN", "-nan", "0", "-1", "-0.5"});
    }
    void noReturnIsNoNumberOfMetres() {
        QFETCH(QByteArray, range);
        const QByteArray poses = pose(0, 0, 0) + pose(0, 0, 0), ranges = "1 " + range + " 2";
        for (const QByteArray &text : {flaser(ranges, poses), robotScan(ranges, poses)}) {
            const auto log = read(text);
            QVERIFY2(log.ok(), log ? "" : log.error().message().c_str());
            QCOMPARE(returns(log->scans[0]), 2);
            QCOMPARE(log->scans[0].maxRange, text.startsWith('R') ? 30.0 : 1000.0);
        }
    }

    void aRangeThatManyRaysHaveIsNoWall_data() {
        const Rows<QByteArray, bool> row("range", "is");
        for (const char *range : {"8.191", "12", "29.99", "33"})
            row(range, range, true);
        row("as far as a wall", "7", false);
        row("beyond the walls, seldom", "12", false);
        row("all rays", "0.5", false);
    }
    /// Walls up to 8 m and, in a third of the rays, the range.
    void aRangeThatManyRaysHaveIsNoWall() {
        FETCH(QByteArray, range, bool, is);
        const bool isSeldom = QByteArray(QTest::currentDataTag()).contains("seldom");
        const bool isAlone = range == "0.5";
        QByteArray text;
        for (int scan = 0; scan < 20; ++scan) {
            QByteArrayList ranges;
            for (int ray = 0; ray < 181; ++ray) {
                const bool hasReturn = isSeldom ? ray != scan || scan > 8 : ray % 3 != 0;
                ranges += isAlone || !hasReturn ? range
                                                : QByteArray::number(2 + (ray * 37 + scan * 11) % 600 * 0.01);
            }
            text += flaser(ranges.join(' '), pose(0, 0, 0) + pose(0, 0, 0));
        }
        const auto log = read(text);
        QCOMPARE(log->noReturn.has_value(), is);
        if (!is)
            return;
        QCOMPARE(log->noReturn->range, range.toFloat());
        QCOMPARE(log->noReturn->rays, std::size_t(20 * 61));
        for (const CarmenScan &scan : log->scans)
            QCOMPARE(returns(scan), 120);
        QVERIFY(!read(text, {false, {}, {}, 40.0})->noReturn); // told otherwise
    }
    /// A robot that stands before the far end of a corridor sees it in many rays, but not beyond all else.
    void theEndOfACorridorIsAWall() {
        QByteArray text;
        for (int scan = 0; scan < 50; ++scan) {
            QByteArrayList ranges;
            for (int ray = 0; ray < 181; ++ray) {
                const double angle = (ray - 90) * pi / 180,
                             side = 1 / std::max(1e-9, std::abs(std::sin(angle)));
                ranges += QByteArray::number(std::round(std::min(10 / std::cos(angle), side) * 100) / 100);
            }
            text += robotScan(ranges.join(' '), pose(0, 0, 0) + pose(0, 0, 0));
        }
        QVERIFY(!read(text)->noReturn);
    }

    void sensorOnRobot_data() {
        const Rows<QByteArray, Pose2D> row("text", "mount");
        const QByteArray parameters = "PARAM robot_frontlaser_offset 0.3 host 0\nPARAM "
                                      "robot_frontlaser_side_offset -0.1\nPARAM "
                                      "robot_frontlaser_angular_offset 1.5\n";
        const auto drive = [](const Pose2D &mount, double drift = 0) {
            QByteArray text;
            for (int i = 0; i < 20; ++i) {
                const Pose2D robot{500000 + 0.1 * i, 4e6, 0.2 * i}, laser = robot * mount;
                const auto exact = [](double v) { return QByteArray::number(v, 'f', 6) + ' '; };
                text += flaser("1 1", exact(laser.x + drift * i) + exact(laser.y) + exact(laser.theta) +
                                          exact(robot.x) + exact(robot.y) + exact(robot.theta));
            }
            return text;
        };
        row("in the middle", drive({}), Pose2D());
        row("ahead", drive({0.2, 0, 0}), Pose2D{0.2, 0, 0});
        row("backwards", drive({-0.2, 0.05, pi}), Pose2D{-0.2, 0.05, pi});
        row("a corrected pose", drive({}, 0.1), Pose2D());
        row("no robot is so long", drive({20, 0, 0}), Pose2D());
        row("told by parameters alone", parameters + drive({}), Pose2D{0.3, -0.1, 1.5});
        row("poses go before parameters", parameters + drive({0.2, 0, 0}), Pose2D{0.2, 0, 0});
    }
    void sensorOnRobot() {
        FETCH(QByteArray, text, Pose2D, mount);
        const auto log = read(text);
        QVERIFY2(log.ok(), log ? "" : log.error().message().c_str());
        const Pose2D found = log->sensorOnRobot(CarmenOdometryKind::Raw);
        QVERIFY(std::hypot(found.x - mount.x, found.y - mount.y) < 1e-5);
        QVERIFY(std::abs(wrapAngle(found.theta - mount.theta)) < 1e-5);
        const Pose2D corrected = log->sensorOnRobot(CarmenOdometryKind::Corrected);
        QVERIFY(corrected.x == 0 && corrected.y == 0 && corrected.theta == 0);
        // The odometry is that of the sensor.
        CarmenDrive drive(*log, CarmenOdometryKind::Raw, found);
        drive.advance();
        const Pose2D at = drive.odometry()->at(2.5).pose();
        QVERIFY(std::hypot(at.x - found.x, at.y - found.y) < 1e-9);
    }

    void lineEnds_data() {
        const Rows<QByteArray> row("end");
        row("LF", "\n");
        row("CR LF", "\r\n");
        row("CR", "\r");
    }
    void lineEnds() {
        QFETCH(QByteArray, end);
        const QByteArray scan = robotScan(alike(181), pose(0, 0, 0) + pose(0, 0, 0)).trimmed() + end;
        const auto log = read(scan.repeated(300)); // over the blocks that are read
        QVERIFY2(log.ok(), log ? "" : log.error().message().c_str());
        QCOMPARE(log->scans.size(), std::size_t(300));
        QCOMPARE(log->scans[299].line, std::size_t(300));
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
            scan(0) + odom(1, 0, 0) + "FLASER 2 1 x\n" + odom(50, 0, 0) + odom(52, 0, 0) + scan(9), true);
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
        row("not a number", flaser("1 one", pose(0, 0, 0) + pose(0, 0, 0)),
            "a.log:1:", "range 2 of 2, a number");
        row("infinite pose", flaser("1 2", "0 inf 0 " + pose(0, 0, 0)), "a.log:1:", "y of a pose");
        row("pose beyond all measure", flaser("1 2", "0 1e300 0 " + pose(0, 0, 0)),
            "a.log:1:", "y of a pose below 1e7");
        const QByteArray other = robotScan("1 2", pose(0, 0, 0) + pose(0, 0, 0));
        for (const auto &[first, name] : {std::pair(good, "FLASER"), std::pair(other, "ROBOTLASER1")})
            for (const QByteArray &second : {good, other, odom(0, 0, 0)})
                for (const char *between : {"", " "}) // a line end that was lost
                    row(qPrintable(QString(name) + between + second.left(6)),
                        first.trimmed() + between + second, "a.log:1: found a line that goes on to", name);
        row("odometry and a scan", odom(0, 0, 0).trimmed() + good, "a.log:1:", "10 fields of ODOM");
        for (const char *message : {"NEFF 20", "PARAM a b host 0", "RLASER 1 1 0 0 0 0 0 0 1 h 1 "})
            for (const QByteArray &second : {good, other})
                row(qPrintable(QString(message) + second.left(6)), good + message + second,
                    "a.log:2:", "one message a line");
        row("over a turn", robotScan(alike(371), pose(0, 0, 0) + pose(0, 0, 0), "0.01745"),
            "a.log:1:", "found 371 rays 0.01745 rad apart, expected rays within a turn");
        row("no longest range", "PARAM robot_front_laser_max far\n" + good,
            "a.log:1:", "found \"far\", expected a value of robot_front_laser_max");
        row("no field of view", "PARAM laser_front_laser_fov 400\n" + good,
            "a.log:1:", "found \"400\", expected a value of laser_front_laser_fov");
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
