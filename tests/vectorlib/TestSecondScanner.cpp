// Drives with two scanners.
#include "TwoScanners.h"

class TestSecondScanner : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void bothMakeOneMap_data() {
        QTest::addColumn<double>("fieldOfView");
        QTest::addColumn<bool>("hasOdometry");
        QTest::addColumn<double>("period");
        for (const double degrees : {180.0, 240.0})
            for (const bool odometry : {true, false}) {
                const double period = odometry == (degrees > 200) ? 0.1 : 0.14;
                QTest::addRow("%.0f degrees, %s, every %.2f s", degrees,
                              odometry ? "odometry" : "scans alone", period)
                    << degrees * pi / 180 << odometry << period;
            }
    }
    void bothMakeOneMap() {
        QFETCH(double, fieldOfView);
        QFETCH(bool, hasOdometry);
        QFETCH(double, period);
        Robot one, two;
        one.fieldOfView = two.fieldOfView = fieldOfView;
        one.hasOdometry = two.hasOdometry = hasOdometry;
        two.period2 = period;
        double taken = 0;
        two.watch = [&](double now) { taken = taken == 0 && two.tracker.second().isTaken() ? now : taken; };
        one.drive(20, false);
        two.drive(20);
        double length1 = 0, length2 = 0;
        const double far1 = one.farthest(0.98, &length1), far2 = two.farthest(0.98, &length2);
        qInfo("taken at %.1f s; off the walls %.1f mm and %.1f; errors %.1f mm and %.1f; %.1f m and %.1f of "
              "wall",
              taken, 1e3 * far1, 1e3 * far2, 1e3 * one.meanError(), 1e3 * two.meanError(), length1, length2);
        QVERIFY(two.tracker.second().isTaken());
        QVERIFY(taken < (fieldOfView > 4 ? 3 : 9));
        QVERIFY(far2 < 0.02);
        QVERIFY(length2 > length1);
        QVERIFY(two.meanError() < std::max(0.005, 1.1 * one.meanError()));
        QCOMPARE(two.tracker.counts().lost, 0u);
        const Pose2D fitting = *two.tracker.second().fitting();
        QVERIFY(!Transformation2D(two.second.inverse() * fitting).exceeds(0.03, 0.015));
    }

    // What failed before has to agree at more places.
    void eachFailureMakesTheTrialLonger() {
        Robot robot;
        robot.fieldOfView = 4 * pi / 3;
        const auto isBad = [](double now) { return now > 8 && std::fmod(now, 8) < 1; };
        robot.alter = [&](SecondScan scan, double now) {
            if (isBad(now))
                scan.points = robot.scan2(room, Pose2D{1, 4.5, now});
            return scan;
        };
        std::vector<double> trials; // seconds, after it was bad
        robot.watch = [&](double now) {
            if (now > 8 && !isBad(now) && robot.tracker.second().isTaken() &&
                trials.size() < std::size_t(now / 8))
                trials.push_back(std::fmod(now, 8) - 1);
        };
        robot.drive(32);
        QCOMPARE(trials.size(), std::size_t(3));
        qInfo("taken again after %.1f s, %.1f s, %.1f s", trials[0], trials[1], trials[2]);
        QVERIFY(trials[2] > trials[0] + 0.6);
    }

    // A map that was cleared begins where the first one is.
    void definesNoMap() {
        Robot robot;
        robot.fieldOfView = 4 * pi / 3;
        robot.firstIsSilent = [](double now) { return now > 12 && now < 14; };
        bool wasTaken = false, isCleared = false;
        robot.watch = [&](double now) {
            if (now > 12 && !std::exchange(isCleared, now > 12)) {
                wasTaken = robot.tracker.second().isTaken();
                robot.tracker.clear();
            } else if (isCleared && now < 14) {
                QVERIFY(robot.tracker.builder.map.isEmpty());
            }
        };
        robot.drive(16);
        QVERIFY(wasTaken && !robot.tracker.builder.map.isEmpty());
    }

    // It stands, and its map is made anew each second: both agree at one place only.
    void mapMadeAnewIsNoOtherPlace() {
        Robot robot;
        robot.at = [](double) { return Pose2D{4.7, 1, 0}; };
        robot.fieldOfView = 4 * pi / 3;
        int scans = 0;
        robot.watch = [&](double) {
            if (++scans % 10 != 0)
                return;
            const Transformation2D moved(Pose2D{0.5, -0.2, 0.2});
            VectorMap anew;
            robot.tracker.builder.map.forEach([&](const MapEdge &e) { anew.add(moved * e, e.observations); });
            robot.tracker.correct(anew, moved);
        };
        robot.drive(8);
        QCOMPARE(robot.tracker.counts().lost, 0u);
        QCOMPARE(robot.tracker.second().state(), State::OnTrial);
    }

    // Walls leave a direction open there, but what the second sees of its own motion does not.
    void goodOneIsTakenWhereWallsAreOpen_data() {
        QTest::addColumn<std::vector<Segment>>("walls");
        QTest::addColumn<double>("degrees");
        QTest::newRow("hall, 180 degrees") << hall << 180.0;
        QTest::newRow("corridor, 240 degrees") << corridor << 240.0;
    }
    void goodOneIsTakenWhereWallsAreOpen() {
        QFETCH(std::vector<Segment>, walls);
        QFETCH(double, degrees);
        Robot one, two;
        for (Robot *robot : {&one, &two}) {
            robot->walls = walls;
            robot->at = straightOn;
            robot->fieldOfView = degrees * pi / 180;
            robot->drive(11, robot == &two);
        }
        double length1 = 0, length2 = 0;
        const double far1 = one.farthest(0.98, &length1), far2 = two.farthest(0.98, &length2);
        qInfo("state %d; off the walls %.1f mm and %.1f; %.1f m and %.1f of wall",
              int(two.tracker.second().state()), 1e3 * far1, 1e3 * far2, length1, length2);
        QVERIFY(two.tracker.second().isTaken());
        QVERIFY(far2 < 0.02);
        QVERIFY(length2 > length1 + 3);
    }

    // TestBadSecondScanner has mounts that are turned by more.
    void wrongOneIsLeftOut_data() {
        QTest::addColumn<Pose2D>("told");
        QTest::addColumn<bool>("mirrored");
        QTest::addColumn<bool>("elsewhere");
        QTest::newRow("3 degrees") << Pose2D{-0.25, 0, pi + 0.052} << false << false;
        QTest::newRow("0.3 m aside") << Pose2D{-0.25, 0.3, pi} << false << false;
        QTest::newRow("mirrored") << Pose2D{-0.25, 0, pi} << true << false;
        QTest::newRow("another robot's") << Pose2D{-0.25, 0, pi} << false << true;
    }
    void wrongOneIsLeftOut() {
        QFETCH(Pose2D, told);
        QFETCH(bool, mirrored);
        QFETCH(bool, elsewhere);
        Robot robot;
        robot.fieldOfView = 4 * pi / 3;
        robot.told = told;
        robot.alter = [&](SecondScan scan, double now) {
            if (mirrored)
                for (Point &p : scan.points)
                    p.y = -p.y;
            if (elsewhere)
                scan.points = robot.scan2(room, Pose2D{1, 4.5 + 0.02 * now, 0.3 * now});
            return scan;
        };
        double taken = 0;
        robot.watch = [&](double now) { taken = robot.tracker.second().isTaken() ? now : taken; };
        robot.drive(12);
        qInfo("state %d, last taken at %.1f s, off the walls %.1f mm", int(robot.tracker.second().state()),
              taken, 1e3 * robot.farthest(0.98));
        QVERIFY(robot.farthest(0.98) < 0.02);
        QCOMPARE(taken, 0.0);
        QVERIFY(robot.tracker.second().state() != State::Taken);
        if (mirrored || elsewhere)
            return;
        QCOMPARE(robot.tracker.second().state(), State::Contradicted);
        QVERIFY(!Transformation2D(robot.second.inverse() * *robot.tracker.second().fitting())
                     .exceeds(0.05, 0.02));
    }

    void secondGoesOnAlone() {
        Robot robot;
        robot.fieldOfView = 4 * pi / 3;
        robot.firstIsSilent = [](double now) { return now > 5 && now < 10; };
        robot.drive(15);
        qInfo("errors %.1f mm, at most %.1f; off the walls %.1f mm", 1e3 * robot.meanError(),
              1e3 * *std::max_element(robot.errors.begin(), robot.errors.end()), 1e3 * robot.farthest(0.95));
        QCOMPARE(robot.tracker.counts().matched, robot.tracker.counts().scans);
        QVERIFY(*std::max_element(robot.errors.begin(), robot.errors.end()) < 0.03);
        QVERIFY(robot.farthest(0.95) < 0.02);
    }

    // It sweeps for 0.145 s about the very moment of the first one's scan.
    void isStraightened() {
        Robot robot;
        robot.fieldOfView = 4 * pi / 3;
        robot.firstIsSilent = [](double now) { return now > 5; };
        robot.alter = [&](SecondScan scan, double now) {
            scan = {{}, {}, 0.1 * std::ceil(10 * now) - 14.5 / 200, 360};
            for (int part = 0; part < 30; ++part) {
                const Pose2D place = robotAt(scan.stamp + part / 200.0) * robot.second;
                for (const Point &p : robot.scan2(room, place))
                    if (int((std::atan2(p.y, p.x) / robot.fieldOfView + 0.5) * 29.99) == part) {
                        scan.points.push_back(p);
                        scan.seconds.push_back(float(part) / 200);
                    }
            }
            return scan;
        };
        robot.drive(12);
        qInfo("errors %.1f mm, at most %.1f; off the walls %.1f mm", 1e3 * robot.meanError(),
              1e3 * *std::max_element(robot.errors.begin(), robot.errors.end()), 1e3 * robot.farthest(0.95));
        QCOMPARE(robot.tracker.counts().matched, robot.tracker.counts().scans);
        QVERIFY(*std::max_element(robot.errors.begin(), robot.errors.end()) < 0.03);
        QVERIFY(robot.farthest(0.95) < 0.02);
    }

    // On the way a part of its points comes to lie behind walls; the others still agree.
    void hiddenPartIsLeftOut() {
        Robot robot;
        robot.fieldOfView = 4 * pi / 3;
        robot.alter = [&](SecondScan scan, double now) {
            for (Point &p : scan.points)
                if (now > 5 && std::atan2(p.y, p.x) > 0.6)
                    p = p * 3;
            return scan;
        };
        double last = 0;
        robot.watch = [&](double now) { last = robot.tracker.second().isTaken() ? now : last; };
        robot.drive(12);
        qInfo("last taken at %.1f s", last);
        QVERIFY(last > 4.9 && last < 6);
    }

    // While the robot drives it is turned by 10 degrees, and back.
    void turnedOnTheWay() {
        Robot robot;
        robot.fieldOfView = 4 * pi / 3;
        robot.alter = [&](SecondScan scan, double now) {
            if (now > 5 && now < 8)
                for (Point &p : scan.points)
                    p = Transformation2D(0, 0, 0.175) * p;
            return scan;
        };
        double left = 0, again = 0;
        robot.watch = [&](double now) {
            const bool taken = robot.tracker.second().isTaken();
            left = now > 5 && left == 0 && !taken ? now : left;
            again = now > 8 && again == 0 && taken ? now : again;
        };
        robot.drive(14);
        qInfo("left out at %.1f s, taken again at %.1f; off the walls %.1f mm", left, again,
              1e3 * robot.farthest(0.98));
        QVERIFY(left > 5 && left < 6);
        QVERIFY(again > 10 && again < 13); // later than the first time
        QVERIFY(robot.farthest(0.98) < 0.02);
    }
};
