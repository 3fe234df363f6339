// The kinds of drive: their formulas against the geometry of the simulated wheels, what they refuse, and
// their limits.
#include "DriveKind.h"

using namespace hermes;
using namespace hermes::motorcontrol;
using vectorlib::pi;

Q_DECLARE_METATYPE(vectorlib::Twist2D)
Q_DECLARE_METATYPE(hermes::motorcontrol::WheelValues)

namespace {

constexpr double period = 0.02;

bool isNear(const Twist2D &a, const Twist2D &b, double most = 1e-9) {
    return std::abs(a.vx - b.vx) < most && std::abs(a.vy - b.vy) < most && std::abs(a.omega - b.omega) < most;
}

} // namespace

class TestKinematics : public QObject {
    Q_OBJECT

    static void rowsOfKinds() {
        const Rows<QString> row("kind");
        for (const auto &[name, kind] : DriveKind::all())
            row(qPrintable(name), name);
    }
    double drawn(double most) { return std::uniform_real_distribution<double>(-most, most)(random_); }
    /// One that the kind can do.
    Twist2D drawnTwist(const WheelLayout &layout) {
        Twist2D twist{drawn(2), layout.movesSideways() ? drawn(2) : 0, drawn(2)};
        if (layout.steers())
            twist.omega = twist.vx * drawn(1 / layout.leastRadius());
        return twist;
    }

    std::mt19937 random_{7};

private Q_SLOTS:
    void inverseAndForwardAgree_data() { rowsOfKinds(); }

    void inverseAndForwardAgree() {
        QFETCH(QString, kind);
        const DriveKind &k = DriveKind::of(kind);
        const WheelLayout layout = k.wheels();
        for (int run = 0; run < 2000; ++run) {
            const Twist2D twist = drawnTwist(layout);
            const WheelValues speeds = layout.wheelSpeeds(twist);
            const double steering = k.steers() ? layout.steering(twist.omega / twist.vx) : 0;
            QVERIFY(isNear(layout.twist(speeds, steering), twist));
            QVERIFY(layout.slip(speeds, steering) < 1e-9);
            QVERIFY(isNear(k.base().twistOf(speeds, 0.5 + steering), twist, 1e-7));
        }
    }

    // Also where the wheels fight each other.
    void anySpeedsMoveTheBodyAsTold_data() { rowsOfKinds(); }

    void anySpeedsMoveTheBodyAsTold() {
        QFETCH(QString, kind);
        const DriveKind &k = DriveKind::of(kind);
        const WheelLayout layout = k.wheels();
        for (int run = 0; run < 2000; ++run) {
            WheelValues speeds{};
            for (int i = 0; i < wheelCount; ++i)
                speeds[i] = layout.has(i) ? drawn(20) : 0;
            if (!k.steers() || k.rearMotors == 1) // else the ground decides between motors and steering
                QVERIFY(isNear(layout.twist(speeds), k.base().twistOf(speeds), 1e-7));
        }
    }

    void wheelsTurnAsTheFormulaHasIt_data() {
        const Rows<QString, Twist2D, WheelValues> row("kind", "twist", "expected");
        const double s = 10 * std::sin(0.9), c = 10 * std::cos(0.9); // radius 0.1, angle 0.9, lever 0.3
        row("two_wheels ahead", "two_wheels", {1, 0, 0}, {10, 10, 0, 0});
        row("two_wheels turn", "two_wheels", {0, 0, 1}, {-2, 2, 0, 0});
        row("omni4 ahead", "omni4", {1, 0, 0}, {-s, c, -c, s});
        row("omni4 left", "omni4", {0, 1, 0}, {c, s, -s, -c});
        row("omni4 turn", "omni4", {0, 0, 1}, {3, 3, 3, 3});
        row("omni3 turn", "omni3", {0, 0, 1}, {3, 3, 3, 0});
        row("omni3 ahead", "omni3", {1, 0, 0},
            {-s, -10 * std::sin(0.9 + 4 * pi / 3), -10 * std::sin(0.9 + 2 * pi / 3), 0});
        row("ackermann bend", "ackermann", {1, 0, 0.5}, {0, 0, 10, 0});
        row("ackermann bend, two motors", "ackermann, two motors", {1, 0, 0.5}, {0, 0, 9, 11});
    }

    void wheelsTurnAsTheFormulaHasIt() {
        FETCH(QString, kind, Twist2D, twist, WheelValues, expected);
        const WheelValues speeds = DriveKind::of(kind).wheels().wheelSpeeds(twist);
        for (int i = 0; i < wheelCount; ++i)
            QVERIFY2(std::abs(speeds[i] - expected[i]) < 1e-9, wheelNames[i]);
    }

    // The fact sheet of mecanum wheels: the fastest one of any motion.
    void aMotionNeedsTheSumOfItsParts() {
        const WheelLayout mecanum = DriveKind::of("mecanum").wheels();
        QVERIFY(std::abs(mecanum.largestSpeed({0.5, 0.2, 1}) - (0.5 + 0.2 + 0.45) / 0.1) < 1e-9);
    }

    void refusesWhatItCannot_data() {
        const Rows<QString, Twist2D, QString> row("kind", "twist", "reason");
        const QString sideways = "vy is 0.1, expected 0: these wheels do not move the robot sideways";
        row("differential sideways", "differential", {0.5, 0.1, 0}, sideways);
        row("two_wheels sideways", "two_wheels", {0.5, 0.1, 0}, sideways);
        row("ackermann sideways", "ackermann", {0.5, 0.1, 0}, sideways);
        row("on the spot", "ackermann", {0, 0, 0.1},
            "omega is 0.1, expected 0: the robot does not turn on the spot");
        row("too tight", "ackermann", {0.5, 0, 0.43},
            "from -0.422793 to 0.422793 rad/s: the robot does not turn on "
            "the spot, its smallest radius is 1.18 m");
        row("too tight backward", "ackermann", {-0.5, 0, 0.43}, "smallest radius is 1.18 m");
        row("as tight as it can", "ackermann", {0.5, 0, 0.5 * std::tan(0.4) / 0.5}, "");
        row("ackermann stands", "ackermann", {0, 0, 0}, "");
        row("too fast a turn", "ackermann", {1, 0, 1.6}, "omega is 1.6");
        row("omni sideways", "omni3", {0, 1, 1}, "");
        row("on the spot on two wheels", "two_wheels", {0, 0, 1.5}, "");
    }

    void refusesWhatItCannot() {
        FETCH(QString, kind, Twist2D, twist, QString, reason);
        Drive drive;
        drive.configure(DriveKind::of(kind).settings()->drive);
        drive.setReady();
        QVERIFY(drive.acquire(1, "test", 10, 0).ok());
        const auto driven = drive.driveTwist(1, twist, 0, 0);
        QCOMPARE(driven.ok(), reason.isEmpty());
        if (!driven)
            VERIFY_CONTAINS(driven.error().message, reason);
        QVERIFY(driven.ok() || driven.error().is(ErrorCode::OverLimit));
    }

    void refusesWheelsThatItHasNot() {
        Drive drive;
        drive.configure(DriveKind::of("omni3").settings()->drive);
        drive.setReady();
        QVERIFY(drive.acquire(1, "test", 10, 0).ok());
        QVERIFY(drive.driveWheels(1, {1, 2, 3, 0}, 0, 0).ok());
        VERIFY_CONTAINS(drive.driveWheels(1, {0, 0, 0, 1}, 0, 0).error().message,
                        QString("rear_right is 1, expected 0: the layout has no such wheel"));
    }

    void limitsHoldOnTheWayToo_data() { rowsOfKinds(); }

    // Whatever is commanded, and however it changes.
    void limitsHoldOnTheWayToo() {
        QFETCH(QString, kind);
        const DriveKind &k = DriveKind::of(kind);
        Drive::Settings settings = k.settings()->drive;
        const MotionLimits &limits = settings.limits;
        settings.limits.wheelSpeed = 8;
        const WheelLayout &layout = settings.layout;
        Drive drive;
        drive.configure(settings);
        drive.setReady();
        QVERIFY(drive.acquire(1, "test", 10, 0).ok());
        Twist2D before;
        double steering = 0, fastest = 0;
        for (int cycle = 0; cycle < 20000; ++cycle) {
            const double now = cycle * period, ease = 1 + 1e-6;
            if (cycle % 10 == 0) {
                Twist2D twist = drawnTwist(layout);
                twist = {twist.vx / 2, twist.vy / 2, twist.omega / 2};
                if (cycle / 100 % 3 == 0)
                    twist = {};
                if (std::abs(twist.omega) <= limits.velocity.omega)
                    QVERIFY(drive.driveTwist(1, twist, 0, now).ok());
            }
            const WheelValues speeds = drive.step(now);
            const Twist2D twist = layout.twist(speeds, drive.steering());
            const auto within = [&](double value, double old, double most, double change) {
                return std::abs(value) <= most * ease && std::abs(value - old) <= change * period * ease;
            };
            QVERIFY(within(twist.vx, before.vx, limits.velocity.vx, limits.acceleration.vx));
            QVERIFY(within(twist.vy, before.vy, limits.velocity.vy, limits.acceleration.vy));
            QVERIFY2(
                within(twist.omega, before.omega, limits.velocity.omega, limits.acceleration.omega),
                qPrintable(QString("cycle %1: %2 after %3").arg(cycle).arg(twist.omega).arg(before.omega)));
            QVERIFY(
                within(drive.steering(), steering, DriveKind::geometry.largestSteering, limits.steeringRate));
            QVERIFY(layout.slip(speeds, drive.steering()) < 1e-9);
            for (const double speed : speeds)
                fastest = std::max(fastest, std::abs(speed));
            before = twist;
            steering = drive.steering();
        }
        QVERIFY2(fastest > 7 && fastest < 8.2, saying(fastest));
    }

    void slowedItStaysOnItsWay() {
        const DriveKind k = DriveKind::of("ackermann, two motors");
        Drive::Settings settings = k.settings()->drive;
        settings.limits.wheelSpeed = 4; // 0.4 m/s of the outer wheel
        Drive drive;
        drive.configure(settings);
        drive.setReady();
        QVERIFY(drive.acquire(1, "test", 10, 0).ok());
        for (double now = 0; now < 1.6; now += period) {
            const Twist2D twist{now < 1 ? 0.8 : 0, 0, now < 1 ? 0.4 : 0};
            QVERIFY(drive.driveTwist(1, twist, 0, now).ok());
            const WheelValues speeds = drive.step(now);
            const Twist2D told = settings.layout.twist(speeds, drive.steering());
            if (now > 0.5) // then it is steered
                QVERIFY(std::abs(drive.steering() - std::atan(0.5 * 0.5)) < 1e-9);
            QVERIFY(std::abs(told.omega - told.vx * std::tan(drive.steering()) / 0.5) < 1e-9);
            if (now > 0.9 && now < 1)
                QVERIFY(std::abs(told.vx * (1 + 0.5 * 0.2) - 0.4) < 1e-9);
        }
        QCOMPARE(drive.setPoint(), WheelValues{});
        drive.driveTwist(1, {0.5, 0, 0}, 0, 1.6);
        drive.step(1.62);
        const double steering = drive.steering();
        drive.stop(1, "test"); // brakes on its way
        drive.step(1.64);
        QVERIFY(steering < std::atan(0.25) && drive.steering() == steering);
    }

    void settings_data() {
        const Rows<QString, QJsonObject, int, QString> row("kind", "more", "controllers", "refused");
        const auto wheel = [](int controller, int motor) {
            return QJsonObject{{"controller", controller}, {"motor", motor}};
        };
        const auto count = [](int number) {
            return QJsonObject{{"controllers", QJsonObject{{"count", number}}}};
        };
        row("two by default", "mecanum", {}, 2, "");
        row("one for two wheels", "two_wheels", {}, 1, "");
        row("two for three wheels", "omni3", {}, 2, "");
        row("one for a car", "ackermann", {}, 1, "");
        row("each its own", "mecanum",
            {{"wheels", QJsonObject{{"front_right", wheel(2, 1)},
                                    {"rear_left", wheel(3, 1)},
                                    {"rear_right", wheel(4, 2)}}}},
            4, "");
        row("as it is", "mecanum", count(2), 2, "");
        row("addresses of others that are not there", "mecanum",
            {{"controllers",
              QJsonObject{{"1", QJsonObject{{"address", 130}}}, {"2", QJsonObject{{"address", 131}}}}}},
            2, "");
        row("one that turns nothing", "two_wheels", count(2), 0,
            "controllers.count is 2, expected 0 or 1: so many turn wheels");
        row("too few", "mecanum", count(1), 0, "controllers.count");
        row("a gap", "ackermann", {{"wheels", QJsonObject()}}, 0,
            "wheels.rear_left.controller is 2, expected numbers without a gap");
        row("a motor twice", "two_wheels", {{"wheels", QJsonObject{{"front_right", wheel(1, 1)}}}}, 0,
            "wheels.front_right.motor");
        row("same address", "omni4", {{"controllers", QJsonObject{{"2", QJsonObject{{"address", 128}}}}}}, 0,
            "controllers.2.address");
        row("a servo out of its range", "ackermann",
            {{"frame", QJsonObject{{"layout", "ackermann"}, {"servo_per_rad", 2}}}}, 0,
            "frame.servo_per_rad");
    }

    void settings() {
        FETCH(QString, kind, QJsonObject, more, int, controllers, QString, refused);
        const auto settings = DriveKind::of(kind).settings(more);
        if (!refused.isEmpty()) {
            QVERIFY(!settings);
            VERIFY_CONTAINS(settings.error().message, refused);
        } else {
            QVERIFY2(settings.ok(), settings ? "" : qPrintable(settings.error().message));
            QCOMPARE(int(settings->controllers.size()), controllers);
        }
    }
};
