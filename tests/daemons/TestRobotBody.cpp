#include "daemons/simulator/RobotBody.h"

using namespace hermes;
using namespace hermes::simulator;

class TestRobotBody : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void wheelsMoveTheBody_data() {
        const Rows<bool, QVector<double>, QVector<double>> row(
            "mecanum", "wheels", "twist"); // wheels: front left, front right, rear left, rear right
        row("forward", true, {10, 10, 10, 10}, {1, 0, 0});
        row("left", true, {-10, 10, 10, -10}, {0, 1, 0});
        row("turn", true, {-10, 10, -10, 10}, {0, 0, 2});
        row("against each other", true, {10, 10, -10, -10}, {0, 0, 0});
        row("differential forward", false, {10, 10, 10, 10}, {1, 0, 0});
        row("differential turn", false, {-10, 10, -10, 10}, {0, 0, 4});
    }

    void wheelsMoveTheBody() {
        FETCH(bool, mecanum, QVector<double>, wheels, QVector<double>, twist);
        WheelBase base;
        base.kind = mecanum ? WheelBase::Kind::Mecanum : WheelBase::Kind::Differential;
        const Twist2D found = base.twistOf({wheels[0], wheels[1], wheels[2], wheels[3]});
        QVERIFY(std::abs(found.vx - twist[0]) < 1e-12);
        QVERIFY(std::abs(found.vy - twist[1]) < 1e-12);
        QVERIFY(std::abs(found.omega - twist[2]) < 1e-12);
    }

    void arcsAreExact() {
        const auto pose = RobotBody().move({0, 0, 0.3}, {0.5, -0.2, 0.7}, 2);
        QVERIFY(std::abs(pose.x - 0.807012141) < 1e-9 && std::abs(pose.y - 0.575516530) < 1e-9);
        QVERIFY(std::abs(pose.theta - 1.7) < 1e-12);
    }

    void wallsHoldTheRobot() {
        RobotBody body({{{2, -5}, {2, 5}}}, 0.3);
        vectorlib::Pose2D pose{0, 0, 0};
        for (int i = 0; i < 4000; ++i)
            pose = body.move(pose, {1, 0.1, 0}, 0.001);
        QVERIFY(std::abs(pose.x - 1.7) < 1e-9);
        QVERIFY(std::abs(pose.y - 0.4) < 1e-9); // it slides along the wall
        QVERIFY(body.isTouching());
        pose = body.move(pose, {-1, 0, 0}, 0.001);
        QVERIFY(!body.isTouching() && pose.x < 1.7);
    }

    void cornersHoldTheRobot() {
        RobotBody body({{{0, 0}, {5, 0}}, {{0, 1}, {0, 0}}, {{5, 0.7}, {0, 1}}},
                       0.3); // ever narrower to the right
        vectorlib::Pose2D pose{0.5, 0.5, 0};
        for (const Twist2D &twist : {Twist2D{1, 0, 0}, Twist2D{1, 0.5, 0}, Twist2D{1, -0.5, 0},
                                     Twist2D{0, 1, 0}, Twist2D{-1, 1, 0}}) {
            for (int i = 0; i < 5000; ++i) {
                pose = body.move(pose, twist, 0.001);
                const vectorlib::Vector2D<double> at(pose.x, pose.y);
                QVERIFY(at.y >= 0.3 - 1e-9 && at.x >= 0.3 - 1e-9);
                QVERIFY((vectorlib::LineSegment2D<double>({5, 0.7}, {0, 1}).distance(at) >= 0.3 - 1e-9));
            }
        }
    }
};
