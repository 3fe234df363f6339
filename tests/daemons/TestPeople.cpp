#include "daemons/simulator/RobotBody.h"

using namespace hermes;
using namespace hermes::simulator;
using Point = vectorlib::Vector2D<double>;

static constexpr double step = 0.001; // seconds
static constexpr double robotRadius = 0.3;
static const Point farAway(100, 100);

static void pass(People &people, double seconds, Point robot) {
    for (int i = 0; i < std::lround(seconds / step); ++i)
        people.advance(step, robot);
}

class TestPeople : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void walkToAndFro_data() {
        const Rows<double, double, double> row("seconds", "x", "y");
        row("begin", 0.0, 0.0, 0.0);
        row("first leg", 2.0, 1.0, 0.0);
        row("second leg", 5.0, 2.0, 0.5);
        row("end", 6.0, 2.0, 1.0);
        row("way back", 7.0, 2.0, 0.5);
        row("begin again", 12.0, 0.0, 0.0);
        row("second time", 14.0, 1.0, 0.0);
    }

    void walkToAndFro() {
        FETCH(double, seconds, double, x, double, y);
        People people({{0.5, {{0, 0}, {2, 0}, {2, 1}}}}, robotRadius);
        pass(people, seconds, farAway);
        QVERIFY((people.all()[0].position - Point(x, y)).norm() < 0.005);
    }

    void stopBeforeTheRobotAndTurnBack() {
        People people({{1, {{0, 0}, {10, 0}}}}, robotRadius);
        const Point robot(5, 0);
        const double nearest = robotRadius + People::distance + People::radius;
        pass(people, 5 - nearest + 1, robot);
        QVERIFY(std::abs(people.all()[0].position.x - (5 - nearest)) < 0.005);
        pass(people, People::longestWait + 1, robot);
        QVERIFY(people.all()[0].position.x < 5 - nearest - 1.5);
        pass(people, 30, robot); // to the begin and here again
        QVERIFY(people.all()[0].position.x <= 5 - nearest);
    }

    void walkAwayFromARobotBesideThem() {
        People people({{1, {{0, 0}, {10, 0}}}}, robotRadius);
        pass(people, 2, {-0.5, 0});
        QVERIFY(std::abs(people.all()[0].position.x - 2) < 0.005);
    }

    void holdTheRobot() {
        const People people({{1, {{2, 0}, {3, 0}}}}, robotRadius);
        RobotBody body({}, robotRadius);
        Pose2D pose{0, 0, 0};
        for (int i = 0; i < 3000; ++i) {
            pose = body.move(pose, {1, 0, 0}, step, people);
            QVERIFY(std::hypot(pose.x - 2, pose.y) > robotRadius + People::radius - 1e-9);
        }
        QVERIFY(body.isTouching());
        QVERIFY(std::abs(pose.x - (2 - robotRadius - People::radius)) < 1e-6);
    }
};
