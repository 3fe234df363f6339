#include "daemons/motorcontrol/MotorSettings.h"

#include "common/interface/InterfaceUrl.h"
#include "common/settings/DottedPath.h"
#include "protocol/roboclaw/Command.h"
#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <cmath>

namespace hermes::motorcontrol {
namespace {

constexpr double rounding_v = 1e-9; // of differences of decimal fractions
// Speeds of the rim in m/s: what may count as standing, and be given up to friction.
constexpr double standingRim = 0.05, frictionRim = 0.1;
constexpr double leastCounts = 2;   // a second, of a wheel that turns: one may be jitter
constexpr double longestHold_s = 1; // beyond braking

Field positive(const char *name, const char *description, const char *unit, double least, double most,
               double initial) {
    return Field::number(name, description).unit(unit).range(least, most).byDefault(initial);
}

void declareControllers(const std::function<void(const Field &)> &declare) {
    for (int i = 1; i <= controllerCount; ++i) {
        const QString group = QString("controllers.%1.").arg(i);
        declare(Field::text(group + "url",
                            "Its serial line, as serial:///dev/ttyACM0?baud=115200; controllers with "
                            "the same URL share the line")
                    .byDefault(roboclaw::usualLine)
                    .appliesOnRestart()
                    .group("Controllers"));
        declare(Field::integer(group + "address", "Its address on the line")
                    .range(128, 135)
                    .byDefault(roboclaw::firstAddress + i - 1)
                    .appliesOnRestart()
                    .group("Controllers"));
    }
    declare(positive("controllers.timeout_s", "Without a byte for so long the controllers stop by themselves",
                     "s", 0.1, 0.5, 0.2)
                .step(0.1)
                .group("Controllers"));
    declare(positive("pid.p", "Proportional part of the controllers' velocity control", "", 0, 1000, 1)
                .group("PID"));
    declare(positive("pid.i", "Integral part", "", 0, 1000, 0.5).group("PID"));
    declare(positive("pid.d", "Differential part", "", 0, 1000, 0.25).group("PID"));
    declare(Field::integer("pid.qpps", "Encoder counts a second at full duty")
                .unit("1/s")
                .range(100, 20000000)
                .byDefault(150000)
                .group("PID"));
}

void declareFrame(const std::function<void(const Field &)> &declare) {
    declare(Field::text("frame.layout", "How the wheels move the robot")
                .choices({"mecanum", "differential"})
                .byDefault("mecanum")
                .group("Wheels"));
    declare(positive("frame.wheel_radius_m", "Radius of a wheel", "m", 0.01, 1, 0.1).group("Wheels"));
    declare(positive("frame.half_base_m", "From the centre to an axle, along x", "m", 0.01, 5, 0.25)
                .group("Wheels"));
    declare(positive("frame.half_track_m", "From the centre to the middle of a wheel, along y", "m", 0.01, 5,
                     0.25)
                .group("Wheels"));
    declare(positive("frame.counts_per_turn", "Encoder counts in one turn of a wheel", "", 1, 1e7, 38000)
                .group("Wheels"));
    for (int i = 0; i < wheelCount; ++i) {
        const QString group = QString("wheels.%1.").arg(wheelNames[i]);
        declare(Field::integer(group + "controller", "Which controller turns it")
                    .range(1, controllerCount)
                    .byDefault(i < 2 ? 1 : 2)
                    .group("Wheels"));
        declare(Field::integer(group + "motor", "1 for M1, 2 for M2")
                    .range(1, 2)
                    .byDefault(i % 2 + 1)
                    .group("Wheels"));
        declare(Field::boolean(group + "reversed", "Positive counts drive the robot backward")
                    .byDefault(false)
                    .group("Wheels"));
    }
}

void declareMotion(const std::function<void(const Field &)> &declare) {
    declare(positive("motion.vx", "Largest speed forward and back", "m/s", 0.01, 10, 1).group("Motion"));
    declare(positive("motion.vy", "Largest speed sideways", "m/s", 0.01, 10, 1).group("Motion"));
    declare(positive("motion.omega", "Largest rate of turn", "rad/s", 0.01, 20, 1.5).group("Motion"));
    declare(
        positive("motion.ax", "Largest acceleration forward and back", "m/s^2", 0.01, 20, 1).group("Motion"));
    declare(positive("motion.ay", "Largest acceleration sideways", "m/s^2", 0.01, 20, 1).group("Motion"));
    declare(
        positive("motion.alpha", "Largest acceleration of the turn", "rad/s^2", 0.01, 50, 3).group("Motion"));
    declare(
        positive("motion.motor_share", "Share of pid.qpps up to which the motors are used", "", 0.1, 1, 0.95)
            .group("Motion"));
    declare(positive("safety.command_timeout_s", "Without a motion command for so long the robot stops", "s",
                     0.05, 2, 0.25)
                .group("Safety"));
    declare(positive("safety.deceleration", "With which the controllers brake in a stop", "m/s^2", 0.1, 20, 4)
                .group("Safety"));
    declare(positive("odometry.position_per_metre", "Standard deviation of the position after one metre", "m",
                     0, 1, 0.02)
                .group("Odometry"));
    declare(positive("odometry.heading_per_metre", "Standard deviation of the heading after one metre", "rad",
                     0, 1, 0.01)
                .group("Odometry"));
    declare(positive("odometry.heading_per_radian",
                     "Standard deviation of the heading after a turn of one radian", "rad", 0, 1, 0.03)
                .group("Odometry"));
}

void declareFaults(const std::function<void(const Field &)> &declare) {
    const auto add = [&](const char *name, const char *description, const char *unit, double most,
                         double initial) {
        declare(positive(name, description, unit, 0, most, initial).group("Faults"));
    };
    add("faults.battery_warning_v", "Below it the battery is reported as low", "V", 60, 23);
    add("faults.battery_v", "Below it the robot stops", "V", 60, 21.5);
    add("faults.current_warning_a", "Above it the current of a motor is reported as high", "A", 200, 30);
    add("faults.current_a", "Above it the robot stops", "A", 200, 45);
    add("faults.temperature_warning_c", "Above it a controller is reported as hot", "Cel", 200, 70);
    add("faults.temperature_c", "Above it the robot stops", "Cel", 200, 85);
    add("faults.hold_s", "How long a value must be beyond", "s", 60, 1);
    add("faults.encoder_commanded_rad_s", "Wheels told to turn slower than this may stand still", "rad/s",
        100, 0.5);
    declare(positive("faults.encoder_moving_rad_s", "Wheels slower than this count as standing", "rad/s",
                     0.001, 100, 0.25)
                .group("Faults"));
    add("faults.encoder_hold_s", "How long a wheel must disobey; longer than braking takes", "s", 10, 0.7);
}

void declareBattery(const std::function<void(const Field &)> &declare) {
    const auto add = [&](const char *name, const char *description, const char *unit, double least,
                         double most, double initial) {
        declare(positive(name, description, unit, least, most, initial).group("Battery"));
    };
    add("battery.capacity_ah", "Charge of the full battery", "Ah", 0.001, 10000, 26);
    add("battery.full_v", "Its voltage when it is full and has rested", "V", 1, 60, 25.4);
    add("battery.empty_v", "Its voltage when it is empty and has rested", "V", 0, 60, 23.4);
    add("battery.idle_a", "What computers and sensors draw: the controllers do not measure it", "A", 0.01,
        100, 2);
    add("battery.reserve", "Share of the charge that is to be left: deep discharge harms lead-acid batteries",
        "", 0, 0.9, 0.2);
    add("battery.warning_s", "With less time left the battery is reported as low", "s", 0, 36000, 600);
}

// A device, or a serial server.
bool isLine(const QString &url) {
    const auto parsed = InterfaceUrl::parse(url);
    return parsed && ((parsed->scheme == "serial" && !parsed->path.isEmpty()) ||
                      (parsed->scheme == "tcp" && !parsed->host.isEmpty() && parsed->port != 0));
}

// What watches the wheels sees each motion that matters, in time, and takes no braking for a fault
// (docs/safety.md).
void checkWatch(const std::function<double(const QString &)> &number,
                const std::function<void(bool, const QString &, const QString &)> &require) {
    const double radius = number("frame.wheel_radius_m"), moving = number("faults.encoder_moving_rad_s");
    require(
        moving * radius <= standingRim, "faults.encoder_moving_rad_s",
        QString("at most %1 rad/s: %2 m/s at the rim").arg(standingRim / radius, 0, 'g', 3).arg(standingRim));
    require(
        number("faults.encoder_commanded_rad_s") * radius <= frictionRim, "faults.encoder_commanded_rad_s",
        QString("at most %1 rad/s: %2 m/s at the rim").arg(frictionRim / radius, 0, 'g', 3).arg(frictionRim));
    require(moving * number("frame.counts_per_turn") >= 4 * vectorlib::pi * leastCounts,
            "frame.counts_per_turn",
            QString("at least %1: with fewer nothing shows within a second whether a wheel turns with "
                    "faults.encoder_moving_rad_s")
                .arg(4 * vectorlib::pi * leastCounts / moving, 0, 'g', 3));
    // motor.wheels may ask for all that the motors give.
    const double braking = number("motion.motor_share") * number("pid.qpps") /
                           number("frame.counts_per_turn") * 2 * vectorlib::pi * radius /
                           number("safety.deceleration");
    const double hold = number("faults.encoder_hold_s");
    require(hold >= braking, "faults.encoder_hold_s",
            QString("at least the %1 s that braking from the largest speed of a wheel takes")
                .arg(braking, 0, 'g', 3));
    require(hold <= braking + longestHold_s, "faults.encoder_hold_s",
            QString("at most %1 s: %2 s more than braking takes")
                .arg(braking + longestHold_s, 0, 'g', 3)
                .arg(longestHold_s));
}

} // namespace

void declareMotorSettings(const std::function<void(const Field &)> &declare) {
    declareControllers(declare);
    declareFrame(declare);
    declareMotion(declare);
    declareFaults(declare);
    declareBattery(declare);
}

std::vector<SchemaViolation> checkMotorSettings(const QJsonObject &settings) {
    std::vector<SchemaViolation> wrong;
    const auto number = [&](const QString &path) { return valueAt(settings, path).toDouble(); };
    const auto require = [&](bool fine, const QString &path, const QString &expected) {
        if (!fine)
            wrong.push_back({path, valueAt(settings, path), expected});
    };
    for (const QString &path : {QString("controllers.1.url"), QString("controllers.2.url")})
        require(isLine(valueAt(settings, path).toString()), path,
                "a line, as serial:///dev/ttyACM0?baud=115200 or, of a serial server, tcp://HOST:PORT");
    require(valueAt(settings, "controllers.1.url") != valueAt(settings, "controllers.2.url") ||
                number("controllers.1.address") != number("controllers.2.address"),
            "controllers.2.address", "another address than that of controller 1, which is on the same line");
    QStringList motors;
    for (const char *name : wheelNames) {
        const QString group = QString("wheels.%1.").arg(name);
        const QString motor = QString("%1/%2").arg(number(group + "controller")).arg(number(group + "motor"));
        require(!motors.contains(motor), group + "motor", "a motor that turns no other wheel");
        motors.append(motor);
    }
    require(number("faults.battery_v") <= number("faults.battery_warning_v"), "faults.battery_v",
            "at most faults.battery_warning_v");
    require(number("battery.full_v") - number("battery.empty_v") >= 0.1 - rounding_v, "battery.full_v",
            "at least 0.1 V more than battery.empty_v");
    require(number("faults.current_a") >= number("faults.current_warning_a"), "faults.current_a",
            "at least faults.current_warning_a");
    require(number("faults.temperature_c") >= number("faults.temperature_warning_c"), "faults.temperature_c",
            "at least faults.temperature_warning_c");
    require(number("faults.encoder_moving_rad_s") <= number("faults.encoder_commanded_rad_s"),
            "faults.encoder_moving_rad_s", "at most faults.encoder_commanded_rad_s");
    checkWatch(number, require);
    return wrong;
}

MotorSettings MotorSettings::from(const Settings &settings) {
    const auto number = [&](const QString &path) { return settings.number(path); };
    MotorSettings s;
    s.wheelRadius = number("frame.wheel_radius_m");
    s.countsPerTurn = number("frame.counts_per_turn");
    const WheelGeometry geometry{s.wheelRadius, number("frame.half_base_m"), number("frame.half_track_m")};
    s.drive.layout = settings.text("frame.layout") == "mecanum" ? WheelLayout::mecanum(geometry)
                                                                : WheelLayout::differential(geometry);
    s.drive.limits.velocity = {number("motion.vx"), number("motion.vy"), number("motion.omega")};
    s.drive.limits.acceleration = {number("motion.ax"), number("motion.ay"), number("motion.alpha")};
    s.drive.limits.wheelSpeed =
        number("motion.motor_share") * number("pid.qpps") * 2 * vectorlib::pi / s.countsPerTurn;
    s.drive.commandTimeout_s = number("safety.command_timeout_s");
    s.emergencyDeceleration = number("safety.deceleration");
    s.odometry = {number("odometry.position_per_metre"), number("odometry.heading_per_metre"),
                  number("odometry.heading_per_radian")};
    for (int i = 0; i < controllerCount; ++i) {
        const QString group = QString("controllers.%1.").arg(i + 1);
        s.controllers[i] = {settings.text(group + "url"), settings.integer(group + "address")};
    }
    for (int i = 0; i < wheelCount; ++i) {
        const QString group = QString("wheels.%1.").arg(wheelNames[i]);
        s.wheels[i] = {settings.integer(group + "controller") - 1, settings.integer(group + "motor") - 1,
                       settings.flag(group + "reversed") ? -1.0 : 1.0};
    }
    s.pid = {number("pid.p"), number("pid.i"), number("pid.d"), settings.integer("pid.qpps")};
    s.serialTimeout_s = number("controllers.timeout_s");
    const double hold = number("faults.hold_s");
    s.battery = {number("faults.battery_warning_v"), number("faults.battery_v"), hold};
    s.current = {number("faults.current_warning_a"), number("faults.current_a"), hold};
    s.temperature = {number("faults.temperature_warning_c"), number("faults.temperature_c"), hold};
    s.encoder = {number("faults.encoder_commanded_rad_s"), number("faults.encoder_moving_rad_s"),
                 number("faults.encoder_hold_s"),
                 s.emergencyDeceleration / s.wheelRadius / 2}; // motors lag behind
    s.gauge = {number("battery.capacity_ah"), number("battery.full_v"), number("battery.empty_v"),
               number("battery.idle_a"), number("battery.reserve")};
    s.batteryWarning_s = number("battery.warning_s");
    return s;
}

} // namespace hermes::motorcontrol
