// Each kind of drive is driven along figures by the whole motor control, over emulated controllers on a clock
// of its own; what its wheels tell is where the body is.
#include "DriveKind.h"
#include "tests/system/campaign/VirtualRobot.h"

using namespace hermes;
using namespace hermes::motorcontrol;
using vectorlib::pi;

namespace {

constexpr double period = 0.02;

/// A robot that somebody drives; its clock goes on with run().
struct Robot {
    struct Leg {
        Twist2D twist;
        double seconds;
    };
    static constexpr quint64 client = 1;

    explicit Robot(const DriveKind &kind)
        : settings(*kind.settings())
        , robot(settings, kind.drivetrain()) {}

    void run(double seconds) {
        robot.run(robot.now() + seconds, [] {});
    }
    bool isReady() {
        for (int i = 0; i < robot.engine->controllers(); ++i) {
            if (!robot.engine->controller(i).isReady())
                return false;
        }
        return true;
    }
    QString why() { return robot.engine->controller(0).error(); }
    bool acquire() {
        for (int i = 0; i < 100 && !isReady(); ++i)
            run(period);
        run(2 * period);
        return robot.engine->drive().acquire(client, "test", 10, robot.now()).ok();
    }
    /// At 20 Hz; false when a command is refused.
    bool drive(const std::vector<Leg> &legs) {
        for (const Leg &leg : legs) {
            for (const double end = robot.now() + leg.seconds; robot.now() < end - 1e-9;) {
                if (!robot.engine->drive().driveTwist(client, leg.twist, 0, robot.now()))
                    return false;
                const double x = robot.truth.x, y = robot.truth.y;
                run(std::min(0.05, end - robot.now()));
                way += std::hypot(robot.truth.x - x, robot.truth.y - y);
            }
        }
        return true;
    }
    const Telemetry &told() { return robot.engine->report(); }

    MotorSettings settings;
    campaign::VirtualRobot robot;
    double way = 0;
};

std::vector<Robot::Leg> legsOf(const QString &figure, const WheelLayout &layout) {
    const double v = 0.5, omega = 0.4;
    const Robot::Leg stand{{}, 1}, left{{v, 0, omega}, 2 * pi / omega}, right{{v, 0, -omega}, 2 * pi / omega},
        side{{v, 0, 0}, 4};
    if (figure == "circle")
        return {left, stand};
    if (figure == "eight")
        return {left, right, stand};
    if (layout.movesSideways())
        return {side, {{0, v, 0}, 4}, {{-v, 0, 0}, 4}, {{0, -v, 0}, 4}, stand};
    const Robot::Leg round{{v, 0, omega}, pi / 2 / omega}, spot{{0, 0, pi / 4}, 2};
    std::vector<Robot::Leg> legs;
    for (int i = 0; i < 4; ++i) {
        if (layout.steers())
            legs.insert(legs.end(), {side, round});
        else
            legs.insert(legs.end(), {side, stand, spot, stand});
    }
    legs.push_back(stand);
    return legs;
}

} // namespace

class TestFigures : public QObject {
    Q_OBJECT
private Q_SLOTS:
    // The example of the fact sheet: 10 rad/s with 38,000 counts in a turn.
    void mecanumIsToldTheCountsOfItsFacts() {
        Robot robot(DriveKind::of("mecanum"));
        QVERIFY(robot.acquire() && robot.drive({{{1, 0, 0}, 2}}));
        for (int i = 0; i < wheelCount; ++i)
            QCOMPARE(robot.robot.robot.wheel(i).target(), 60479.0);
    }

    void theServoIsToldWithTheWheels() {
        Robot robot(DriveKind::of("ackermann"));
        QVERIFY2(robot.acquire(), qPrintable(robot.why()));
        QVERIFY(robot.drive({{{0.5, 0, 0.4}, 2}}));
        DriveEngine &engine = *robot.robot.engine;
        engine.cycle(robot.robot.now() + period);
        const auto ask =
            engine.controller(0).next(MotorController::Task::SetPoint, robot.robot.now() + period);
        QVERIFY(ask && ask->command.servo);
        QVERIFY(std::abs(*ask->command.servo - (0.5 + std::atan(0.8 * 0.5))) < 1e-9);
        QCOMPARE(robot.told().steering, robot.told().targetSteering);
    }

    void figures_data() {
        const Rows<QString, QString> row("kind", "figure");
        for (const auto &[kind, what] : DriveKind::all())
            for (const QString figure : {"square", "circle", "eight"})
                row(qPrintable(kind + ", " + figure), kind, figure);
    }

    // What the wheels tell is where the body is, to 1 % of its way.
    void figures() {
        FETCH(QString, kind, QString, figure);
        Robot robot(DriveKind::of(kind));
        QVERIFY2(robot.acquire(), qPrintable(robot.why()));
        QVERIFY2(robot.drive(legsOf(figure, robot.settings.drive.layout)),
                 qPrintable(robot.told().haltReason));
        const Pose2D truth = robot.robot.truth, told = robot.told().pose;
        const double off = std::hypot(told.x - truth.x, told.y - truth.y);
        const double turned = std::abs(std::remainder(told.theta - truth.theta, 2 * pi));
        if (qEnvironmentVariableIsSet("HERMES_FIGURES"))
            qInfo("off by %.4f m and %.4f rad after %.1f m; it closes to %.3f m", off, turned, robot.way,
                  std::hypot(truth.x, truth.y));
        QVERIFY2(robot.way > 7, saying(robot.way));
        QVERIFY2(off < 0.01 * robot.way, saying(off));
        QVERIFY2(turned < 0.02, saying(turned)); // a servo is told thousandths of its way
        QVERIFY2(std::hypot(truth.x, truth.y) < 0.05 * robot.way, saying(std::hypot(truth.x, truth.y)));
        QVERIFY(!robot.told().latch.isSet());
    }

    // Other wheels while it runs: lines are opened at the start.
    void aControllerThatIsNotOpenMovesNothing() {
        Robot robot(DriveKind::of("two_wheels"));
        QVERIFY(robot.acquire() && robot.drive({{{0.5, 0, 0}, 1}}));
        robot.robot.engine->configure(*DriveKind::of("mecanum").settings());
        robot.run(1);
        const auto refused = robot.robot.engine->drive().acquire(1, "test", 10, robot.robot.now());
        QVERIFY(!refused);
        VERIFY_CONTAINS(refused.error().message, QString("controller 2, which is opened at the next start"));
        QVERIFY(!robot.robot.robot.isMoving());
        robot.robot.engine->configure(*DriveKind::of("two_wheels").settings());
        QVERIFY(robot.acquire() && robot.drive({{{0.5, 0, 0}, 1}}));
    }
};
