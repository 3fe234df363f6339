#include "Pillars.h"
#include "daemons/simulator/PosePath.h"
#include "vectorlib/geometry/Angle.h"

using namespace hermes;
using namespace hermes::simulator;

class TestPathFollower : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void pathPassesThroughThePoses() {
        const World world = pillars();
        const PosePath path(world.poses, 0.8, 1);
        QVERIFY(path.length() > 25.4 / 0.8 && path.length() < 40);
        const auto first = path.poseAt(-1), last = path.poseAt(path.length() + 1);
        QCOMPARE(first.x, world.poses.front().x);
        QCOMPARE(last.x, world.poses.back().x);
        for (const Pose2D &pose : world.poses) {
            double nearest = 1e9, heading = 0;
            for (double p = 0; p < path.length(); p += 0.002) {
                const auto at = path.poseAt(p);
                const double distance = std::hypot(at.x - pose.x, at.y - pose.y);
                heading = distance < nearest ? at.theta : heading;
                nearest = std::min(nearest, distance);
            }
            QVERIFY(nearest < 0.002);
            QVERIFY(std::abs(vectorlib::wrapAngle(heading - pose.theta)) < 0.01);
        }
    }

    void pathKeepsItsLimits() {
        const World world = pillars();
        const PosePath path(world.poses, 0.8, 0.5);
        const double step = 0.01;
        for (double p = 0; p + step < path.length(); p += step) {
            const auto a = path.poseAt(p), b = path.poseAt(p + step);
            QVERIFY(std::hypot(b.x - a.x, b.y - a.y) < 0.8 * step * 1.001);
            QVERIFY(std::abs(vectorlib::wrapAngle(b.theta - a.theta)) < 0.5 * step * 1.001);
            const Twist2D twist = path.twistAt(p, 1);
            QVERIFY(std::hypot(twist.vx, twist.vy) <= 0.8 * 1.001 && std::abs(twist.omega) <= 0.5 * 1.001);
            QVERIFY(distanceToWalls(world, {a.x, a.y}) > 0.35);
        }
    }

    void pathTurnsTheShorterWay() {
        const PosePath path({{0, 0, 3}, {1, 0, -3}, {1, 0, -3}, {1, 0, 3}}, 1, 1);
        for (double p = 0; p < path.length(); p += 0.01)
            QVERIFY(std::abs(path.poseAt(p).theta) > 2.9);
        QVERIFY(PosePath({}, 1, 1).isEmpty());
        QCOMPARE(PosePath({{1, 2, 3}}, 1, 1).length(), 0.0);
        QCOMPARE(PosePath({{1, 2, 3}}, 1, 1).poseAt(5).y, 2.0);
    }

    void followerStandsDrivesAndStops() {
        PathFollower follower(PosePath({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}}, 1, 1), 0.5);
        follower.advance(1);
        QCOMPARE(follower.pose().x, 0.0);
        follower.drive();
        double last = 0, lastRate = 0, seconds = 0;
        while (follower.isDriving() && seconds < 20) {
            follower.advance(0.001);
            seconds += 0.001;
            QVERIFY(follower.pose().x >= last);
            QVERIFY(follower.pose().x - last <= 0.001 * 1.0001);
            QVERIFY(std::abs(follower.rate() - lastRate) < 0.0012 || follower.isFinished());
            last = follower.pose().x;
            lastRate = follower.rate();
        }
        QVERIFY(follower.isFinished());
        QCOMPARE(follower.pose().x, 4.0);
        QVERIFY(seconds > 5.9 && seconds < 6.2); // 4 m at 1 m/s and 2 s for speeding up and braking
        QCOMPARE(follower.rate(), 0.0);
    }

    void followerHaltsSmoothly() {
        PathFollower follower(PosePath({{0, 0, 0}, {10, 0, 0}}, 1, 1), 0.5);
        follower.drive();
        for (int i = 0; i < 4000; ++i)
            follower.advance(0.001);
        QVERIFY(std::abs(follower.twist().vx - 1) < 1e-6);
        const double from = follower.pose().x;
        follower.halt();
        for (int i = 0; i < 4000; ++i)
            follower.advance(0.001);
        QVERIFY(std::abs(follower.pose().x - from - 1) < 0.01); // v^2 / 2a
        QVERIFY(!follower.isDriving() && follower.rate() == 0 && !follower.isFinished());
    }
};
