#include <vectorlib/graph/LoopCloser.h>
#include <vectorlib/mapping/ScanTracker.h>

#include "tests/vectorlib/RingBuilding.h"

#include <QtTest>

using namespace vectorlib;

namespace {

Transformation2D between(const Pose2D &from, const Pose2D &to) {
    return Transformation2D(from).inverse() * Transformation2D(to);
}
/// Of motions between places that were met again; metres.
double revisitError(const std::vector<Pose2D> &drive, const std::vector<Pose2D> &found) {
    double sum = 0;
    int pairs = 0;
    for (std::size_t k = 0; k < drive.size(); ++k)
        for (std::size_t i = 0; i + 100 < k; ++i)
            if (std::hypot(drive[i].x - drive[k].x, drive[i].y - drive[k].y) < 2) {
                sum += (between(drive[i], drive[k]).inverse() * between(found[i], found[k]))
                           .translation()
                           .norm();
                ++pairs;
            }
    return pairs > 0 ? sum / pairs : 1e9;
}
bool isWrong(const PoseConstraint &c, const std::vector<Pose2D> &drive) {
    const Transformation2D off = between(drive[c.from], drive[c.to]).inverse() * c.motion;
    return off.translation().norm() > 0.5 || std::abs(off.alpha()) > 0.17;
}

} // namespace

/// Drives that come back to where they were.
class TestLoopCloser : public QObject {
    Q_OBJECT

    /// A drive through a building, tracked by a scanner on slipping wheels.
    struct Tracked {
        std::vector<Pose2D> drive, tracked;
        LoopCloser loops;
    };
    static void track(std::mt19937 &random, Tracked &result) {
        RingBuilding building(random);
        result.drive = building.drive(2);
        const ScanWorld::Scanner scanner{361, 1.5 * pi, 0.01 + 0.01 * double(random() % 3),
                                         8 + double(random() % 12)};
        std::normal_distribution<double> noise;
        ScanTracker tracker;
        Pose2D wheels = result.drive[0];
        tracker.place(wheels);
        for (std::size_t i = 0; i < result.drive.size(); ++i) {
            if (i > 0) {
                const Transformation2D m = between(result.drive[i - 1], result.drive[i]);
                const double slip = (1 + 0.05 * noise(random)) * (random() % 50 == 0 ? 0.5 : 1);
                wheels = (Transformation2D(wheels) *
                          Transformation2D(m.x() * slip, m.y() * slip,
                                           m.alpha() * (1 + 0.05 * noise(random)) + 0.005 * noise(random)))
                             .pose();
            }
            TimedScan scan;
            scan.points = building.world.scan(Transformation2D(result.drive[i]), random, scanner);
            scan.stamp = 0.3 * double(i);
            scan.odometry.emplace(0, std::vector<OdometrySample>{{scan.stamp, wheels, {}, {}}});
            scan.rays = std::size_t(scanner.rays);
            scan.fieldOfView = scanner.fieldOfView;
            scan.closed = false;
            const ScanReport &report = tracker.process(scan);
            result.tracked.push_back(report.pose);
            result.loops.add(scan.points, report.pose,
                             report.outcome == ScanReport::Outcome::Matched ? TrackedBy::Map
                                                                            : TrackedBy::Odometry);
        }
    }

private Q_SLOTS:
    // Rooms and corridors that are alike, wheels that slip: no loop that is wrong may be believed. The same
    // with HERMES_PLANS buildings.
    void roomsThatAreAlikeFoldNoMap() {
        const int plans = qEnvironmentVariableIntValue("HERMES_PLANS") > 0
                              ? qEnvironmentVariableIntValue("HERMES_PLANS")
                              : 6;
        const unsigned seed = unsigned(QDateTime::currentMSecsSinceEpoch());
        qInfo("seed %u", seed);
        std::size_t closed = 0;
        int folded = 0, wrong = 0;
        double sum = 0;
        for (int plan = 0; plan < plans; ++plan) {
            std::mt19937 random(seed + unsigned(plan));
            Tracked t;
            track(random, t);
            closed += t.loops.close().closed;
            int believed = 0;
            for (const PoseConstraint &c : t.loops.graph().constraints)
                if (c.mayBeWrong && isWrong(c, t.drive)) {
                    ++wrong;
                    believed += c.weight >= 0.25;
                }
            folded += believed > 0;
            sum += revisitError(t.drive, t.loops.poses());
        }
        qInfo("%d buildings: %zu loops closed, %d wrong motions found, %d folded, %.3f m at revisits", plans,
              closed, wrong, folded, sum / plans);
        QVERIFY(closed > std::size_t(50 * plans));
        QVERIFY2(folded <= plans / 50, qPrintable(QString::number(folded)));
        QVERIFY(sum / plans < 0.10);
    }

    // Where the way is told 1 % too long and every turn a little wrong.
    void aDriveThatBentIsBroughtTogether() {
        std::mt19937 random(1); // others may bend beyond all reach
        std::normal_distribution<double> noise;
        RingBuilding building(random);
        const std::vector<Pose2D> drive = building.drive(2);
        LoopCloser loops;
        std::vector<Pose2D> bent{drive[0]};
        for (std::size_t i = 0; i < drive.size(); ++i) {
            if (i > 0) {
                const Transformation2D m = between(drive[i - 1], drive[i]);
                bent.push_back(
                    (Transformation2D(bent.back()) *
                     Transformation2D(m.x() * 1.01, m.y(), m.alpha() + 0.0003 + 0.003 * noise(random)))
                        .pose());
            }
            loops.add(building.world.scan(Transformation2D(drive[i]), random, {361, 1.5 * pi, 0.02, 12}),
                      bent.back(), TrackedBy::Map);
        }
        const double before = revisitError(drive, bent);
        loops.close();
        const double after = revisitError(drive, loops.poses());
        qInfo("%.3f to %.3f", before, after);
        QVERIFY2(before > 0.3 && after < 0.05, qPrintable(QString("%1 to %2").arg(before).arg(after)));
    }

    // As it was tracked: poses stay to the last digit where nothing is met again.
    void aDriveWithoutLoopsStays() {
        std::mt19937 random(4);
        LoopCloser loops;
        QCOMPARE(loops.close().tried, std::size_t(0));
        const ScanWorld room = ScanWorld::room();
        std::vector<Pose2D> poses;
        for (int i = 0; i < 10; ++i) {
            poses.push_back({0.1 * i, 0.02 * i, 0.01 * i});
            loops.add(room.scan(Transformation2D(poses.back()), random), poses.back(), TrackedBy::Map);
        }
        const LoopCounts counts = loops.close();
        QCOMPARE(counts.tried, std::size_t(0));
        for (std::size_t i = 0; i < poses.size(); ++i)
            QVERIFY(std::hypot(loops.poses()[i].x - poses[i].x, loops.poses()[i].y - poses[i].y) < 1e-9);
    }

    // Without odometry each scan is matched with the one before, whatever it was guessed to be.
    void scansAloneAreEnough() {
        std::mt19937 random(5);
        const ScanWorld room = ScanWorld::room();
        LoopCloser loops;
        std::vector<Pose2D> drive;
        for (int i = 0; i < 20; ++i) {
            drive.push_back({0.15 * i - 1.5, 0.1 * i - 1, 0.2 * i});
            loops.add(room.scan(Transformation2D(drive.back()), random, {720, 2 * pi, 0.01, 30}), {},
                      i == 0 ? TrackedBy::Map : TrackedBy::Nothing);
        }
        loops.close();
        for (std::size_t i = 0; i < drive.size(); ++i) {
            const Transformation2D off =
                between(drive[0], drive[i]).inverse() * between(loops.poses()[0], loops.poses()[i]);
            QVERIFY2(off.translation().norm() < 0.05 && std::abs(off.alpha()) < 0.03,
                     qPrintable(QString::number(i)));
        }
    }

    void scansOfNothingAreNoLoops() {
        LoopCloser loops;
        for (int i = 0; i < 100; ++i)
            loops.add({}, {std::cos(0.2 * i) * 5, std::sin(0.2 * i) * 5, 0.2 * i},
                      i % 3 == 0 ? TrackedBy::Nothing : TrackedBy::Map);
        const LoopCounts counts = loops.close();
        QVERIFY(counts.tried > 0);
        QCOMPARE(counts.closed, std::size_t(0));
        QCOMPARE(counts.refused, counts.tried);
        for (const Pose2D &p : loops.poses())
            QVERIFY(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.theta));
    }
};

QTEST_APPLESS_MAIN(TestLoopCloser)
#include "TestLoopCloser.moc"
