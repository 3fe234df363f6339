// Drives with a second scanner that is bad now and then, or mounted far off: it draws nothing.
#include "TwoScanners.h"

#include <map>
#include <random>
#include <tuple>

// What is wrong with some scans of the second scanner.
enum class Fault { Elsewhere, OtherRoom, Late, FarTimes, MixedTimes, Turned };

// Which ones, by their number: each n-th, or runs of up to 12 that are drawn.
static std::vector<bool> each(int n) {
    std::vector<bool> bad(400);
    for (std::size_t i = 0; i < bad.size(); i += std::size_t(n))
        bad[i] = true;
    return bad;
}
static std::vector<bool> runs(unsigned seed) {
    std::mt19937 random(seed);
    std::vector<bool> bad;
    while (bad.size() < 400)
        bad.insert(bad.end(), 1 + random() % 12, bad.empty() || !bad.back());
    return bad;
}

Q_DECLARE_METATYPE(Fault)
Q_DECLARE_METATYPE(std::vector<bool>)
Q_DECLARE_METATYPE(std::optional<State>)

class TestBadSecondScanner : public QObject {
    Q_OBJECT

    // That it is the map of the first scanner alone.
    void verifyMap(Robot &both) {
        const std::size_t scans = both.errors.size();
        double &length1 = lengths[{both.fieldOfView, both.walls[0].length(), scans}];
        if (length1 == 0) {
            Robot one;
            one.fieldOfView = both.fieldOfView;
            one.walls = both.walls;
            one.at = both.at;
            one.drive(0.1 * double(scans), false);
            one.farthest(0.95, &length1);
        }
        double length2 = 0;
        const double far2 = both.farthest(0.95, &length2);
        qInfo("state %d; off the walls %.1f mm; %.1f m and %.1f of wall", int(both.tracker.second().state()),
              1e3 * far2, length1, length2);
        QVERIFY(far2 < 0.02);
        QVERIFY(std::abs(length2 - length1) < 0.05 * length1);
    }
    std::map<std::tuple<double, float, std::size_t>, double> lengths;

private Q_SLOTS:
    void badOnesDrawNothing_data() {
        QTest::addColumn<Fault>("fault");
        QTest::addColumn<std::vector<bool>>("isBad");
        QTest::addColumn<int>("first"); // of the bad ones
        QTest::addColumn<double>("degrees");
        QTest::addColumn<std::optional<State>>("end");
        const std::pair<Fault, const char *> faults[]{
            {Fault::Elsewhere, "elsewhere"},       {Fault::OtherRoom, "another room"},
            {Fault::Late, "late or early"},        {Fault::FarTimes, "t of seconds"},
            {Fault::MixedTimes, "t out of order"}, {Fault::Turned, "turned"}};
        const std::optional<State> any;
        const int later = 80; // when it was taken
        for (const auto &[fault, name] : faults) {
            const unsigned seed = unsigned(fault);
            QTest::addRow("%s, each 2nd", name)
                << fault << each(2) << 0 << 180.0 << std::optional(State::Contradicted);
            QTest::addRow("%s, runs by seed %u", name, seed) << fault << runs(seed) << 0 << 240.0 << any;
            QTest::addRow("%s, later each 3rd", name)
                << fault << each(3) << later << 240.0 << std::optional(State::Contradicted);
            QTest::addRow("%s, later each 10th", name)
                << fault << each(10) << later << 240.0 << std::optional(State::Taken);
            QTest::addRow("%s, later runs by seed %u", name, seed + 10)
                << fault << runs(seed + 10) << later << 240.0 << any;
        }
        QTest::newRow("elsewhere, each 10th")
            << Fault::Elsewhere << each(10) << 0 << 240.0 << std::optional(State::Taken);
        QTest::newRow("late or early, all")
            << Fault::Late << each(1) << 0 << 180.0 << std::optional(State::Contradicted);
    }
    void badOnesDrawNothing() {
        QFETCH(Fault, fault);
        QFETCH(std::vector<bool>, isBad);
        QFETCH(int, first);
        QFETCH(double, degrees);
        QFETCH(std::optional<State>, end);
        Robot robot;
        robot.fieldOfView = degrees * pi / 180;
        std::mt19937 random(7);
        const auto within = [&random](double most) {
            return std::uniform_real_distribution<double>(-most, most)(random);
        };
        int number = 0, inARow = 0, taken = 0, wrongly = 0;
        robot.alter = [&](SecondScan scan, double now) {
            if (++number <= first || !isBad[std::size_t(number)]) {
                inARow = 0;
                return scan;
            }
            ++inARow;
            if (fault == Fault::Elsewhere)
                scan.points = robot.scan2(room, Pose2D{1, 4.5 + 0.02 * now, 0.3 * now});
            if (fault == Fault::OtherRoom)
                scan.points = robot.scan2(hall, Pose2D{1 + 0.1 * now, 1, 0.3 * now});
            if (fault == Fault::Late)
                scan.stamp += within(0.2);
            if (fault == Fault::FarTimes || fault == Fault::MixedTimes)
                for (std::size_t i = 0; i < scan.points.size(); ++i)
                    scan.seconds.push_back(float(within(fault == Fault::FarTimes ? 1 : 0.05)));
            if (fault == Fault::Turned)
                for (Point &p : scan.points)
                    p = Transformation2D(0, 0, 0.175) * p;
            return scan;
        };
        robot.watch = [&](double) {
            const bool isTaken = robot.tracker.second().isTaken();
            taken += isTaken;
            wrongly += isTaken && inARow > 3 && fault != Fault::Late; // some are hardly late
        };
        robot.drive(34); // once around
        verifyMap(robot);
        QVERIFY(taken > 0 || first == 0);
        QCOMPARE(wrongly, 0);
        if (end)
            QCOMPARE(robot.tracker.second().state(), *end);
    }

    void mountThatFitsElsewhere_data() {
        QTest::addColumn<std::vector<Segment>>("walls");
        QTest::addColumn<Pose2D>("told");
        QTest::addColumn<double>("degrees");
        for (const double degrees : {180.0, 240.0})
            for (const auto &[name, walls] :
                 {std::pair("room", &room), std::pair("hall", &hall), std::pair("corridor", &corridor)})
                for (const double off : {10.0, 90.0, 180.0})
                    QTest::addRow("%s, %.0f degrees, off by %.0f", name, degrees, off)
                        << *walls << Pose2D{-0.25, 0, pi + off * pi / 180} << degrees;
    }
    void mountThatFitsElsewhere() {
        QFETCH(std::vector<Segment>, walls);
        QFETCH(Pose2D, told);
        QFETCH(double, degrees);
        Robot robot;
        robot.fieldOfView = degrees * pi / 180;
        robot.told = told;
        robot.walls = walls;
        if (walls.size() == 4)
            robot.at = straightOn;
        int taken = 0;
        robot.watch = [&](double) { taken += robot.tracker.second().isTaken(); };
        robot.drive(11);
        QCOMPARE(taken, 0);
        verifyMap(robot);
    }

    // While the first is silent the second is matched alone.
    void badOnesAloneDrawNothing() {
        for (const int n : {2, 3, 10}) {
            Robot robot;
            robot.fieldOfView = 4 * pi / 3;
            robot.firstIsSilent = [](double now) { return now > 8 && now < 12; };
            int number = 0;
            bool taken = false;
            robot.watch = [&](double now) { taken = taken || (now < 8 && robot.tracker.second().isTaken()); };
            robot.alter = [&](SecondScan scan, double now) {
                if (++number > 80 && number % n == 0)
                    scan.points = robot.scan2(room, Pose2D{1, 4.5 + 0.02 * now, 0.3 * now});
                return scan;
            };
            robot.drive(34);
            verifyMap(robot);
            QVERIFY(taken);
        }
    }
};
