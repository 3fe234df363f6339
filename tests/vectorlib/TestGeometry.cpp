#include <vectorlib/geometry/LineSegment2D.h>
#include <vectorlib/geometry/Transformation2D.h>
#include <vectorlib/motion/MotionModel.h>

using namespace vectorlib;

class TestGeometry : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void wrapAngle_data() {
        const Rows<double, double> row("angle", "wrapped");
        row("zero", 0.0, 0.0);
        row("pi stays", pi, pi);
        row("minus pi becomes pi", -pi, pi);
        row("three turns", 6 * pi + 0.5, 0.5);
        row("just over", pi + 0.1, -pi + 0.1);
    }

    void wrapAngle() {
        FETCH(double, angle, double, wrapped);
        QVERIFY(std::abs(vectorlib::wrapAngle(angle) - wrapped) < 1e-12);
    }

    void crossIsSigned() { // erratum 11
        const Vector2D<double> x(1, 0), y(0, 1);
        QCOMPARE(x.cross(y), 1.0);
        QCOMPARE(y.cross(x), -1.0);
    }

    void segmentKeepsItsUnitDirection() {
        const LineSegment2D<float> s({1, 2}, {4, 6});
        QCOMPARE(s.direction().x, 0.6f);
        QCOMPARE(s.direction().y, 0.8f);
        QCOMPARE(s.length(), 5.0f);
        QCOMPARE(s.reversed().direction().x, -0.6f);
    }

    void segmentWithoutLength() {
        const LineSegment2D<double> s({1, 1}, {1, 1});
        QCOMPARE(s.length(), 0.0);
        QCOMPARE(s.distance({4, 5}), 5.0);
        QVERIFY(s.direction() == Vector2D<double>());
    }

    void freeSpaceLiesOnTheLeft() {
        // A scanner at the origin turning counter-clockwise sees the wall x = 2 from below to above.
        const LineSegment2D<double> wall({2, -1}, {2, 1});
        QVERIFY(wall.across({0, 0}) > 0);
        QVERIFY(wall.normal().dot(Vector2D<double>(-1, 0)) > 0);
    }

    void overlap() {
        const LineSegment2D<double> s({0, 0}, {10, 0});
        QCOMPARE(s.overlap(LineSegment2D<double>({8, 1}, {14, 1})), 2.0);
        QCOMPARE(s.overlap(LineSegment2D<double>({14, 1}, {8, 1})), 2.0);
        QCOMPARE(s.overlap(LineSegment2D<double>({11, 0}, {14, 0})), 0.0);
    }

    void transformationComposesAndInverts() {
        std::mt19937 random(7);
        std::uniform_real_distribution<double> u(-4, 4);
        for (int i = 0; i < 1000; ++i) {
            const Transformation2D a(u(random), u(random), u(random)), b(u(random), u(random), u(random));
            const Vector2D<double> p(u(random), u(random));
            QVERIFY(((a * b) * p - a * (b * p)).norm() < 1e-12);
            QVERIFY((a.inverse() * (a * p) - p).norm() < 1e-12);
        }
    }

    void sharesMemoryWithEigen() {
        Vector2D<double> v(1, 2);
        v.eigen() *= 3;
        QCOMPARE(v.x, 3.0);
        QCOMPARE(v.y, 6.0);
    }

    void twistAndMotionAreInverse() {
        for (double omega : {0.0, 1e-9, 0.3, -2.0}) {
            const Twist2D twist{0.8, -0.2, omega};
            const Twist2D back = Twist2D::between(twist.motion(0.7), 0.7);
            const Transformation2D direct(twist, 0.7), byPose(twist.motion(0.7));
            QVERIFY((direct * Vector2D<double>(3, -4) - byPose * Vector2D<double>(3, -4)).norm() < 1e-14);
            QVERIFY(std::abs(back.vx - twist.vx) < 1e-9 && std::abs(back.vy - twist.vy) < 1e-9);
            QVERIFY(std::abs(back.omega - twist.omega) < 1e-9);
        }
    }

    void compensationStraightensAWallSeenWhileMoving() {
        const Twist2D twist{1.0, 0.0, 0.5};
        std::vector<Vector2D<float>> points;
        std::vector<float> seconds;
        for (int i = 0; i < 100; ++i) {
            const float t = 0.001f * static_cast<float>(i);
            points.push_back(Transformation2D(twist.motion(t).inverse()) *
                             Vector2D<float>(3, -1 + 0.02f * static_cast<float>(i)));
            seconds.push_back(t);
        }
        QVERIFY(std::abs(points.back().x - 3) > 0.05f);
        QVERIFY(std::abs(middleTime(seconds) - 0.0495f) < 1e-6f);
        compensateMotion(points, seconds, 0, twist);
        for (const Vector2D<float> &p : points)
            QVERIFY(std::abs(p.x - 3) < 1e-5f);
    }

    void motionModelForgetsAfterAPause() {
        MotionModel model;
        model.update({0, 0, 0}, 10.0);
        model.update({0.1, 0, 0}, 10.1);
        QVERIFY(std::abs(model.predict(10.2).x - 0.2) < 1e-12);
        QCOMPARE(model.predict(15.0).x, 0.1);
        model.update({0.2, 0, 0}, 9.0); // a clock that steps back
        QCOMPARE(model.predict(9.1).x, 0.2);
    }

    void motionModelBelievesNoImpossibleVelocity() {
        MotionModel model;
        model.update({0, 0, 0}, 10.0);
        model.update({0.1, 0, 0}, 10.1);
        model.update({0.1125, 0, 0}, 10.1001); // 125 m/s
        QCOMPARE(model.twist().vx, 1.0);
        model.update({0.1225, 0, 0}, 10.1021); // 5 m/s, of the noise
        QCOMPARE(model.twist().vx, 1.0);
        model.update({4, 0, 0}, 10.2); // it leapt
        QCOMPARE(model.twist().vx, 1.0);
        model.update({4, 0, 3}, 10.3); // and turned
        QCOMPARE(model.twist().omega, 0.0);
        model.update({4.2, 0, 3}, 10.4);
        QVERIFY(model.twist().omega == 0 && std::abs(model.twist().vx) < 2);
    }
};
