// Wheel layouts, limits and odometry of hermes-motorcontrol.
#include "daemons/motorcontrol/MotionLimits.h"
#include "daemons/motorcontrol/Odometry.h"

Q_DECLARE_METATYPE(vectorlib::Twist2D)
Q_DECLARE_METATYPE(vectorlib::Pose2D)
Q_DECLARE_METATYPE(hermes::motorcontrol::WheelValues)

using namespace hermes;
using namespace hermes::motorcontrol;
using vectorlib::pi;

class TestMotion : public QObject {
    Q_OBJECT

    static inline const WheelGeometry geometry{0.1, 0.25, 0.2};

    static double distance(const Pose2D &a, const Pose2D &b) { return std::hypot(a.x - b.x, a.y - b.y); }

    static Twist2D randomTwist(std::mt19937 &random) {
        std::uniform_real_distribution<double> value(-2, 2);
        return {value(random), value(random), value(random)};
    }

private Q_SLOTS:
    void wheelsTurnAsNamed_data() {
        const Rows<Twist2D, WheelValues> row("twist", "expected"); // expected: radius 0.1, lever 0.45
        row("forward", {1, 0, 0}, {10, 10, 10, 10});
        row("left", {0, 1, 0}, {-10, 10, 10, -10});
        row("counter-clockwise", {0, 0, 1}, {-4.5, 4.5, -4.5, 4.5});
        row("all", {0.5, -0.2, 0.4}, {5.2, 4.8, 1.2, 8.8});
    }

    void wheelsTurnAsNamed() {
        FETCH(Twist2D, twist, WheelValues, expected);
        const WheelValues speeds = WheelLayout::mecanum(geometry).wheelSpeeds(twist);
        for (int i = 0; i < wheelCount; ++i)
            QVERIFY2(std::abs(speeds[i] - expected[i]) < 1e-12, wheelNames[i]);
    }

    // Eq. (4.1) as printed, with its wheels 1 to 4 at the rear left, rear right, front left and front right.
    void mecanumIsTheMatrixOfTheThesis() {
        const double l = geometry.halfBase + geometry.halfTrack;
        const double matrix[4][3] = {{1, 1, -l}, {1, -1, l}, {1, -1, -l}, {1, 1, l}};
        const Wheel order[4] = {Wheel::RearLeft, Wheel::RearRight, Wheel::FrontLeft, Wheel::FrontRight};
        const Twist2D twist{0.7, -0.3, 1.1};
        const WheelValues speeds = WheelLayout::mecanum(geometry).wheelSpeeds(twist);
        for (int i = 0; i < 4; ++i) {
            const double expected =
                (matrix[i][0] * twist.vx + matrix[i][1] * twist.vy + matrix[i][2] * twist.omega) /
                geometry.radius;
            QVERIFY(std::abs(speeds[int(order[i])] - expected) < 1e-12);
        }
    }

    void forwardIsThePseudoInverse_data() { falseAndTrue("mecanum", "differential", "mecanum"); }

    // The two conditions that define it for a matrix A of full column rank: F A = 1, and A F is symmetric.
    void forwardIsThePseudoInverse() {
        QFETCH(bool, mecanum);
        const WheelLayout layout =
            mecanum ? WheelLayout::mecanum(geometry) : WheelLayout::differential(geometry);
        std::mt19937 random(7);
        for (int run = 0; run < 10000; ++run) {
            Twist2D in = randomTwist(random);
            if (!mecanum)
                in.vy = 0;
            const Twist2D out = layout.twist(layout.wheelSpeeds(in));
            QVERIFY(std::abs(out.vx - in.vx) < 1e-12 && std::abs(out.vy - in.vy) < 1e-12 &&
                    std::abs(out.omega - in.omega) < 1e-12);
        }
        double projection[4][4];
        for (int column = 0; column < 4; ++column) {
            WheelValues unit{};
            unit[column] = 1;
            const WheelValues image = layout.wheelSpeeds(layout.twist(unit));
            for (int row = 0; row < 4; ++row)
                projection[row][column] = image[row];
        }
        for (int row = 0; row < 4; ++row) {
            for (int column = 0; column < 4; ++column)
                QVERIFY(std::abs(projection[row][column] - projection[column][row]) < 1e-12);
        }
    }

    void slipIsWhatNoMotionExplains() {
        const WheelLayout layout = WheelLayout::mecanum(geometry);
        WheelValues speeds = layout.wheelSpeeds({0.5, 0.2, -0.3});
        QVERIFY(layout.slip(speeds) < 1e-12);
        const double residual[] = {3, 3, -3, -3}; // the left null vector of the matrix
        for (int i = 0; i < wheelCount; ++i)
            speeds[i] += residual[i];
        QVERIFY(std::abs(layout.slip(speeds) - 0.3) < 1e-12); // 3 rad/s at 0.1 m
        QVERIFY(std::abs(layout.twist(speeds).vx - 0.5) < 1e-12);
    }

    void differentialIgnoresSideways() {
        const WheelLayout layout = WheelLayout::differential(geometry);
        QVERIFY(!layout.movesSideways());
        QVERIFY(WheelLayout::mecanum(geometry).movesSideways());
        const WheelValues speeds = layout.wheelSpeeds({0, 5, 0});
        for (double speed : speeds)
            QCOMPARE(speed, 0.0);
        QCOMPARE(layout.twist({1, -2, 3, -4}).vy, 0.0);
    }

    void saturationKeepsTheDirection() {
        const WheelLayout layout = WheelLayout::mecanum(geometry);
        const WheelValues wanted = layout.wheelSpeeds({1, 1, 1.5}); // front right: 26.75 rad/s
        const WheelValues given = saturated(wanted, 20);
        const Twist2D twist = layout.twist(given);
        QVERIFY(std::abs(given[int(Wheel::FrontRight)] - 20) < 1e-12);
        QVERIFY(std::abs(twist.vy / twist.vx - 1) < 1e-12);
        QVERIFY(std::abs(twist.omega / twist.vx - 1.5) < 1e-12);
        QCOMPARE(saturated(layout.wheelSpeeds({0.5, 0, 0}), 20), layout.wheelSpeeds({0.5, 0, 0}));
    }

    // 1 m/s at 1 m/s^2 takes longer than the 0.5 rad/s at 3 rad/s^2 that go with it: both arrive together.
    void rampTakesTheTimeOfItsSlowestPart() {
        const WheelLayout layout = WheelLayout::mecanum(geometry);
        const Twist2D acceleration{1, 1, 3};
        const WheelValues target = layout.wheelSpeeds({1, 0, 0.5});
        WheelValues speeds{};
        Twist2D before;
        for (int cycle = 1; cycle <= 50; ++cycle) {
            speeds = ramped(speeds, target, layout, acceleration, 0.02);
            const Twist2D now = layout.twist(speeds);
            QVERIFY(std::abs(now.vx - before.vx) <= 0.02 + 1e-12);
            QVERIFY(std::abs(now.omega - now.vx / 2) < 1e-12);
            QCOMPARE(speeds == target, cycle == 50);
            before = now;
        }
    }

    void rampOfSingleWheelsIsLimited() {
        const WheelLayout layout = WheelLayout::mecanum(geometry);
        const Twist2D acceleration{1, 1, 3};
        // The largest wheel acceleration of any motion: (1 + 1 + 0.45 * 3) / 0.1 = 33.5 rad/s^2.
        const WheelValues twisted{10, 10, -10, -10};
        const WheelValues step = ramped({}, twisted, layout, acceleration, 0.02);
        for (int i = 0; i < wheelCount; ++i)
            QVERIFY(std::abs(step[i] - (i < 2 ? 0.67 : -0.67)) < 1e-12);
    }

    void odometryFollowsArcs_data() {
        const Rows<Pose2D, Twist2D, Pose2D> row("start", "displacement", "end");
        row("straight", {}, {2, 0, 0}, {2, 0, 0});
        row("sideways", {1, 1, pi / 2}, {0, 2, 0}, {-1, 1, pi / 2});
        row("quarter circle", {}, {1, 0, pi / 2}, {2 / pi, 2 / pi, pi / 2});
        row("full circle", {3, 4, 1}, {5, -2, 2 * pi}, {3, 4, 1});
        row("heading wraps", {0, 0, 3}, {0, 0, 1}, {0, 0, 4 - 2 * pi});
        row("heading pi, not -pi", {}, {0, 0, -pi}, {0, 0, pi});
        // Integrated in 200,000 steps.
        row("general", {0, 0, 0.3}, {1, -0.4, 1.4}, {0.807012141, 0.575516530, 1.7});
    }

    void odometryFollowsArcs() {
        FETCH(Pose2D, start, Twist2D, displacement, Pose2D, end);
        Odometry odometry;
        odometry.reset(start);
        odometry.move(displacement);
        QVERIFY(distance(odometry.pose(), end) < 1e-9);
        QVERIFY(std::abs(odometry.pose().theta - end.theta) < 1e-12);
    }

    // A motion with constant velocity ends at the same pose in one step and in a thousand.
    void odometryIsExactForAnyStep() {
        std::mt19937 random(11);
        for (int run = 0; run < 100; ++run) {
            const Twist2D whole = randomTwist(random);
            Odometry once, often;
            once.move(whole);
            for (int i = 0; i < 1000; ++i)
                often.move({whole.vx / 1000, whole.vy / 1000, whole.omega / 1000});
            QVERIFY(distance(once.pose(), often.pose()) < 1e-12);
        }
    }

    void smallTurnsJoinLargeOnes() {
        for (const double turn : {1e-4 * (1 - 1e-9), 1e-4 * (1 + 1e-9)}) {
            Odometry odometry;
            odometry.move({1, 0, turn});
            QVERIFY(std::abs(odometry.pose().x - std::sin(1e-4) / 1e-4) < 1e-13);
            QVERIFY(std::abs(odometry.pose().y - 0.5e-4) < 2e-12);
        }
    }

    // A square of 10 m in cycles of 20 ms, counts rounded as encoders do: under 1 cm and 0.2 degree.
    void squareCloses() {
        const WheelLayout layout = WheelLayout::mecanum(geometry);
        const double radiansPerCount = 2 * pi / 38000;
        Odometry odometry;
        WheelValues angles{};
        std::array<qint64, wheelCount> counts{};
        const auto drive = [&](const Twist2D &twist, int cycles) {
            for (int cycle = 0; cycle < cycles; ++cycle) {
                const WheelValues speeds = layout.wheelSpeeds(twist);
                WheelValues moved{};
                for (int i = 0; i < wheelCount; ++i) {
                    angles[i] += 0.02 * speeds[i];
                    const qint64 count = std::llround(angles[i] / radiansPerCount);
                    moved[i] = double(count - counts[i]) * radiansPerCount;
                    counts[i] = count;
                }
                odometry.move(layout.twist(moved));
            }
        };
        for (int side = 0; side < 4; ++side) {
            drive({0.5, 0, 0}, 1000);
            drive({0, 0, pi / 2 / 2}, 100);
        }
        QVERIFY(distance(odometry.pose(), {}) < 0.01);
        QVERIFY(std::abs(odometry.pose().theta) < 0.2 * pi / 180);
    }

    void covarianceGrowsWithMotionAndTurn() {
        Odometry odometry;
        odometry.setNoise({0.02, 0.01, 0.03});
        odometry.move({0, 0, 0});
        QCOMPARE(odometry.covariance(), Odometry::Covariance{});
        odometry.move({0, 0, 1});
        QVERIFY(std::abs(odometry.covariance()[8] - 0.0009) < 1e-15);
        QCOMPARE(odometry.covariance()[0], 0.0);
        odometry.reset({});
        odometry.move({1, 0, 0});
        QVERIFY(std::abs(odometry.covariance()[0] - 0.0004) < 1e-15);
        odometry.move({1, 0, 0}); // the wrong heading after the first metre turns the second
        QVERIFY(std::abs(odometry.covariance()[0] - 0.0008) < 1e-15);
        QVERIFY(std::abs(odometry.covariance()[4] - (0.0008 + 0.0001)) < 1e-15);
        QVERIFY(std::abs(odometry.covariance()[8] - 0.0002) < 1e-15);
        odometry.doubt(0.1, 0.2);
        QVERIFY(std::abs(odometry.covariance()[0] - 0.0108) < 1e-15);
        QVERIFY(std::abs(odometry.covariance()[8] - 0.0402) < 1e-15);
    }

    // What the covariance predicts is what many runs with that noise show.
    void covarianceIsThatOfManyRuns() {
        const OdometryNoise noise{0.02, 0.01, 0.03};
        const Twist2D step{0.05, 0.01, 0.02};
        const int steps = 100, runs = 4000;
        Odometry odometry;
        odometry.setNoise(noise);
        for (int i = 0; i < steps; ++i)
            odometry.move(step);
        std::mt19937 random(3);
        std::normal_distribution<double> gauss;
        const double length = std::hypot(step.vx, step.vy);
        const double xy = noise.positionPerMetre * std::sqrt(length);
        const double heading = std::sqrt(noise.headingPerMetre * noise.headingPerMetre * length +
                                         noise.headingPerRadian * noise.headingPerRadian * step.omega);
        Odometry::Covariance sample{};
        for (int run = 0; run < runs; ++run) {
            Odometry noisy;
            for (int i = 0; i < steps; ++i) {
                noisy.move(step);
                const Pose2D &p = noisy.pose();
                noisy.reset(
                    {p.x + xy * gauss(random), p.y + xy * gauss(random), p.theta + heading * gauss(random)});
            }
            const double d[3] = {noisy.pose().x - odometry.pose().x, noisy.pose().y - odometry.pose().y,
                                 std::remainder(noisy.pose().theta - odometry.pose().theta, 2 * pi)};
            for (int i = 0; i < 9; ++i)
                sample[i] += d[i / 3] * d[i % 3] / runs;
        }
        for (int i = 0; i < 9; ++i) {
            const double scale =
                std::sqrt(odometry.covariance()[4 * (i / 3)] * odometry.covariance()[4 * (i % 3)]);
            QVERIFY2(std::abs(sample[i] - odometry.covariance()[i]) < 0.1 * scale, saying(i));
        }
    }
};
