#include <vectorlib/graph/LoopCloser.h>
#include <vectorlib/mapping/ScanTracker.h>

#include "tests/vectorlib/OfficeFloor.h"
#include "tests/vectorlib/RevisitError.h"
#include "tests/vectorlib/RingBuilding.h"

using namespace vectorlib;

/// Takes scans by where the drive was tracked, and moves the poses as it goes.
class Closing {
public:
    LoopCloser loops;

    void add(PointSpan<float> points, const Pose2D &tracked, TrackedBy by) {
        loops.add(points, loops.scans() == 0 ? Transformation2D(tracked) : between(last_, tracked), by);
        last_ = tracked;
        if (loops.isDue())
            loops.correct();
    }
    LoopCounts close() {
        loops.correct();
        return loops.counts();
    }
    std::vector<Pose2D> poses() const { return loops.poses(); }
    const PoseGraph &graph() const { return loops.graph(); }

private:
    Pose2D last_;
};
/// Eight equal rooms on both sides of a corridor of 2 m, each with a door and a box.
static ScanWorld rowsOfRooms(double pitch) {
    using Point = ScanWorld::Point;
    ScanWorld world;
    const auto wall = [&](double x0, double y0, double x1, double y1) {
        world.walls.emplace_back(Point(x0, y0), Point(x1, y1));
    };
    constexpr int rooms = 8;
    for (const double side : {-1.0, 1.0}) {
        const double near = side > 0 ? 2 : 0, back = near + side * 3.5;
        for (int i = 0; i < rooms; ++i) {
            const double x = i * pitch, door = x + pitch / 2;
            wall(x, near, door - 0.5, near);
            wall(door + 0.5, near, x + pitch, near);
            wall(x, near, x, back);
            wall(x, back, x + pitch, back);
            wall(x + 0.2, back - side * 0.6, x + 0.8, back - side * 0.6);
            wall(x + 0.8, back - side * 0.6, x + 0.8, back);
        }
        wall(rooms * pitch, near, rooms * pitch, back);
    }
    wall(0, 0, 0, 2);
    wall(rooms * pitch, 0, rooms * pitch, 2);
    return world;
}
static bool isWrong(const PoseConstraint &c, const std::vector<Pose2D> &drive, const LoopCloser &loops) {
    const Transformation2D off =
        between(drive[loops.scanOf(c.from)], drive[loops.scanOf(c.to)]).inverse() * c.motion;
    return off.translation().norm() > 0.5 || std::abs(off.alpha()) > 0.17;
}

/// Drives that come back to where they were.
class TestLoopCloser : public QObject {
    Q_OBJECT

    /// A drive through a building, tracked by a scanner on slipping wheels.
    struct Tracked {
        std::vector<Pose2D> drive, tracked;
        Closing loops;
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
            TimedScan scan =
                timedScan(building.world.scan(Transformation2D(result.drive[i]), random, scanner), scanner,
                          0.3 * double(i), wheels);
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
        const unsigned seed = newSeed();
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
                if (c.mayBeWrong && isWrong(c, t.drive, t.loops.loops)) {
                    ++wrong;
                    believed += c.weight >= 0.25;
                }
            folded += believed > 0;
            sum += revisitError(t.drive, t.loops.poses());
        }
        qInfo("%d buildings: %zu loops closed, %d wrong motions found, %d folded, %.3f m at revisits", plans,
              closed, wrong, folded, sum / plans);
        QVERIFY(closed > std::size_t(50 * plans));
        QVERIFY2(folded <= plans / 50, saying(folded));
        QVERIFY(sum / plans < 0.10);
    }

    // Where the way is told 1 % too long and every turn a little wrong.
    void aDriveThatBentIsBroughtTogether() {
        std::mt19937 random(1); // others may bend beyond all reach
        std::normal_distribution<double> noise;
        RingBuilding building(random);
        const std::vector<Pose2D> drive = building.drive(2);
        Closing loops;
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
        QVERIFY2(before > 0.3 && after < 0.05, saying("%1 to %2", before, after));
    }

    // Around a floor of some 200 m, where wheels turn by 0.002 rad too much on each metre: farther off than
    // the nearest scans are looked for.
    void aLargeLoopThatMissesByFarIsClosed() {
        std::mt19937 random(3); // others may bend by more than the drive allows
        std::normal_distribution<double> noise;
        OfficeFloor floor({62, 44}, random);
        const std::vector<Pose2D> drive = floor.around(0.5);
        Closing loops;
        std::vector<Pose2D> bent{drive[0]};
        double missed = 0;
        for (std::size_t i = 0; i < drive.size(); ++i) {
            if (i > 0) {
                const Transformation2D m = between(drive[i - 1], drive[i]);
                const double way = m.translation().norm();
                const double turn = 0.002 * way + 0.003 * std::sqrt(way) * noise(random);
                bent.push_back(
                    (Transformation2D(bent.back()) * Transformation2D(1.005 * m.x(), m.y(), m.alpha() + turn))
                        .pose());
                const double back = between(drive[0], drive[i]).translation().norm();
                if (back < 0.5)
                    missed = std::max(missed, std::hypot(bent[i].x - drive[i].x, bent[i].y - drive[i].y));
            }
            loops.add(floor.scan(Transformation2D(drive[i]), {361, 1.5 * pi, 0.01, 30}), bent.back(),
                      TrackedBy::Map);
        }
        loops.close();
        const double after = revisitError(drive, loops.poses());
        qInfo("it missed by %.1f m; %.3f m at revisits, %.3f m before", missed, after,
              revisitError(drive, bent));
        QVERIFY(missed > 9);
        QVERIFY2(after < 0.05, saying(after));
    }

    // Eight on a way of two metres each, and one that tells otherwise.
    void loopsThatMoveFarWaitForOthers() {
        LoopAgreement agreement;
        const auto end = [](double way) { return LoopAgreement::End{Transformation2D(way, 0, 0), way}; };
        const auto loop = [&](double from, double to, double off) {
            PoseConstraint c;
            c.motion = Transformation2D(0.5, off, 0.01);
            return agreement.add(c, end(from), end(to), 4);
        };
        for (int i = 0; i < 8; ++i) {
            const double way = 2.0 * i;
            QVERIFY(loop(way, 300 + way, 0.2).empty()); // four agree soon, but on less than 15 m
            if (i == 3)
                QVERIFY(loop(way, 300 + way, 4).empty());
        }
        QVERIFY(agreement.newest(320));
        QVERIFY(!agreement.newest(360));
        QCOMPARE(loop(16, 316, 0.2).size(), std::size_t(9));
        QVERIFY(loop(18, 318, 0.2).empty()); // the others are forgotten
        for (int i = 0; i < 8; ++i)
            QVERIFY(loop(2.0 * i, 500 + 40.0 * i, 0.2).empty()); // too far from each other
    }

    void aScanLooksTheSameHoweverTheSensorTurns() {
        std::mt19937 random(8);
        const ScanWorld room = ScanWorld::room(), grove = ScanWorld::grove();
        const ScanWorld::Scanner scanner{720, 2 * pi, 0.01, 30};
        const ScanSignature here(room.scan({1, 0.5, 0}, random, scanner));
        QVERIFY(here.distance(ScanSignature(room.scan({1, 0.5, 2}, random, scanner))) < 0.1F);
        QVERIFY(here.distance(ScanSignature(room.scan({1.5, 0.5, 1}, random, scanner))) < 0.7F);
        QVERIFY(here.distance(ScanSignature(grove.scan({5, 0, 0}, random, scanner))) > 0.7F);
        const float nan = std::numeric_limits<float>::quiet_NaN();
        const std::vector<Vector2D<float>> broken{{nan, 1}, {1e30F, 1e30F}, {0, 0}};
        QVERIFY(std::isfinite(here.distance(ScanSignature(broken))));
        QVERIFY(std::isfinite(here.distance(ScanSignature())));
    }

    // Rooms that are alike offer loops that are off by the same way and so agree with each other; many scans
    // on a short way are no reason to believe them.
    void aDriveThatWasRightStaysRight() {
        std::mt19937 random(2);
        for (const double pitch : {2.2, 2.6, 3.0}) {
            const ScanWorld world = rowsOfRooms(pitch);
            DriveWay way({0.5, 1, 0}, 0.1);
            for (int i = 0; i < 16; ++i) { // even rooms on the way out, odd ones on the way back
                const int room = i < 8 ? i : 15 - i;
                const double x = (room + 0.5) * pitch;
                way.goTo({x, 1});
                if (room % 2 == (i < 8 ? 0 : 1)) {
                    way.goTo({x, 3.4});
                    way.goTo({x, 1});
                }
            }
            Closing loops;
            for (const Pose2D &pose : way.poses())
                loops.add(world.scan(Transformation2D(pose), random, {361, 1.5 * pi, 0.01, 8}), pose,
                          TrackedBy::Map);
            loops.close();
            double farthest = 0;
            for (std::size_t i = 0; i < way.poses().size(); ++i)
                farthest = std::max(farthest, between(way.poses()[i], loops.poses()[i]).translation().norm());
            QVERIFY2(farthest < 0.2, saying("%1 m, rooms of %2 m", farthest, pitch));
        }
    }

    // As after a matcher was killed: it goes on in rooms that it never saw, like those that it knows, and
    // comes back to these.
    void wherePlacedRoomsThatAreAlikeFoldNoMap() {
        for (const double pitch : {2.6, 3.0, 4.1}) {
            std::mt19937 random(2);
            const ScanWorld world = rowsOfRooms(pitch);
            const auto visit = [&](DriveWay &way, int room) {
                const double x = (room + 0.5) * pitch;
                way.goTo({x, 1});
                way.goTo({x, 3.4});
                way.goTo({x, 1});
            };
            DriveWay before({0.5, 1, 0}, 0.3), after({4.5 * pitch, 1, 0}, 0.3);
            for (int room = 0; room < 4; ++room)
                visit(before, room);
            for (const int room : {4, 5, 6, 7, 6, 5, 4, 3, 2, 1, 0})
                visit(after, room);
            std::vector<Pose2D> drive = before.poses();
            const std::size_t placed = drive.size();
            drive.insert(drive.end(), after.poses().begin(), after.poses().end());
            Closing loops;
            for (std::size_t i = 0; i < drive.size(); ++i)
                loops.add(world.scan(Transformation2D(drive[i]), random, {361, 1.99 * pi, 0.01, 5}), drive[i],
                          i == placed ? TrackedBy::Placed : TrackedBy::Map);
            loops.close();
            int across = 0;
            for (const PoseConstraint &c : loops.graph().constraints)
                across += c.mayBeWrong && !c.isRefused() && loops.loops.scanOf(c.from) < placed &&
                          loops.loops.scanOf(c.to) >= placed;
            double farthest = 0;
            for (std::size_t i = 0; i < drive.size(); ++i)
                farthest = std::max(farthest, between(drive[i], loops.poses()[i]).translation().norm());
            QVERIFY2(farthest < 0.2, saying("%1 m, rooms of %2 m", farthest, pitch));
            QVERIFY2(across > 10, saying("%1 loops, rooms of %2 m", across, pitch));
        }
    }

    // Against drives with noise, drawn.
    void uncertaintyOfADrive() {
        constexpr unsigned seed = 9;
        std::mt19937 random(seed);
        std::normal_distribution<double> noise;
        std::vector<Transformation2D> motions;
        for (int i = 0; i < 60; ++i)
            motions.emplace_back(0.5, 0, i % 15 == 14 ? pi / 2 : 0.02);
        constexpr double xy = 0.01, alpha = 0.004;
        DriveUncertainty told;
        std::vector<Pose2D> drive{{2, 1, 0.4}};
        told.add(drive[0], 0, 0);
        for (const Transformation2D &m : motions) {
            drive.push_back((Transformation2D(drive.back()) * m).pose());
            told.add(drive.back(), xy * xy, alpha * alpha);
        }
        constexpr std::size_t from = 10;
        Eigen::Matrix3d seen = Eigen::Matrix3d::Zero();
        constexpr int runs = 4000;
        for (int run = 0; run < runs; ++run) {
            Transformation2D pose(drive[from]);
            for (std::size_t i = from; i < motions.size(); ++i)
                pose = pose * motions[i] *
                       Transformation2D(xy * noise(random), xy * noise(random), alpha * noise(random));
            const Pose2D &end = drive.back();
            const Eigen::Vector3d off(pose.x() - end.x, pose.y() - end.y,
                                      std::remainder(pose.alpha() - end.theta, 2 * pi));
            seen += off * off.transpose() / runs;
        }
        const Eigen::Matrix3d expected = told.between(from, motions.size());
        QVERIFY((seen - expected).norm() < 0.1 * expected.norm());
        QCOMPARE(expected, Eigen::Matrix3d(expected.transpose()));
        DriveUncertainty far; // in the coordinates of a country
        for (std::size_t i = 0; i < drive.size(); ++i)
            far.add({drive[i].x + 4e6, drive[i].y - 6e6, drive[i].theta}, i > 0 ? xy * xy : 0,
                    i > 0 ? alpha * alpha : 0);
        QVERIFY((far.between(from, motions.size()) - expected).norm() < 1e-6 * expected.norm());
    }

    // As it was tracked: poses stay to the last digit where nothing is met again.
    void aDriveWithoutLoopsStays() {
        std::mt19937 random(4);
        Closing loops;
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
        Closing loops;
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
            QVERIFY2(off.translation().norm() < 0.05 && std::abs(off.alpha()) < 0.03, saying(i));
        }
    }

    void scansOfNothingAreNoLoops() {
        Closing loops;
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
