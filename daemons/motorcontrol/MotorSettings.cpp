#include "daemons/motorcontrol/MotorSettings.h"

#include "common/interface/InterfaceUrl.h"
#include "common/settings/SettingsTable.h"
#include "protocol/drive/ArduinoDevice.h"
#include "protocol/roboclaw/Device.h"
#include "vectorlib/geometry/Angle.h"

#include <algorithm>

namespace hermes::motorcontrol {
namespace {

constexpr double rounding_v = 1e-9; // of differences of decimal fractions
// Speeds of the rim in m/s: what may count as standing, and be given up to friction.
constexpr double standingRim = 0.05, frictionRim = 0.1;
constexpr double leastCounts = 2;   // a second, of a wheel that turns: one may be jitter
constexpr double longestHold_s = 1; // beyond braking

/// Where people mount a wheel.
struct WheelPlace {
    int controller, motor; ///< 1 or 2
    bool reversed = false;
};

/// The settings, and what is checked and made of them.
struct MotorTable : SettingsTable {
    MotorSettings s;
    QString kind = "roboclaw", layout = "mecanum";
    WheelGeometry frame;
    std::array<WheelPlace, wheelCount> wheels{{{1, 1}, {1, 2}, {2, 1}, {2, 2}}};
    double motorShare = 0.95;

    MotorTable();
    explicit MotorTable(const QJsonObject &settings)
        : MotorTable() {
        read(settings);
    }
    void check();
    MotorSettings made();

private:
    void addFaults();
    void addBattery();
    void checkWatch();
    void checkDevices();
    bool isArduino() const { return kind == "arduino"; }
    /// The wheels that have a motor of their own: all, or those in front.
    int driven() const { return isArduino() ? 2 : wheelCount; }
};

MotorTable::MotorTable() {
    group("Controllers");
    add("controllers.kind", kind,
        "What they are: two RoboClaws, or one Arduino with the text protocol of ros_arduino_bridge that "
        "turns "
        "two wheels")
        .choices({"roboclaw", "arduino"})
        .appliesOnRestart();
    for (int i = 0; i < controllerCount; ++i) {
        const QString at = QString("controllers.%1.").arg(i + 1);
        add(qPrintable(at + "url"), s.controllers[i].url,
            "Its serial line, as serial:///dev/ttyACM0?baud=115200; controllers with the same URL share the "
            "line")
            .appliesOnRestart();
        add(qPrintable(at + "address"), s.controllers[i].address, "Its address on the line")
            .range(128, 135)
            .appliesOnRestart();
    }
    add("controllers.timeout_s", s.serialTimeout_s,
        "Without a byte for so long the controllers stop by themselves; an Arduino 2 s after its last "
        "set-point",
        "s", 0.1, 2)
        .step(0.1);
    group("PID");
    add("pid.p", s.pid.p, "Proportional part of the controllers' velocity control", "", 0, 1000);
    add("pid.i", s.pid.i, "Integral part", "", 0, 1000);
    add("pid.d", s.pid.d, "Differential part", "", 0, 1000);
    add("pid.qpps", s.pid.qpps, "Encoder counts a second at full duty", "1/s", 100, 20000000);
    group("Wheels");
    add("frame.layout", layout, "How the wheels move the robot").choices({"mecanum", "differential"});
    add("frame.wheel_radius_m", frame.radius, "Radius of a wheel", "m", 0.01, 1);
    add("frame.half_base_m", frame.halfBase, "From the centre to an axle, along x", "m", 0.01, 5);
    add("frame.half_track_m", frame.halfTrack, "From the centre to the middle of a wheel, along y", "m", 0.01,
        5);
    add("frame.counts_per_turn", s.countsPerTurn, "Encoder counts in one turn of a wheel", "", 1, 1e7);
    for (int i = 0; i < wheelCount; ++i) {
        const QString at = QString("wheels.%1.").arg(wheelNames[i]);
        add(qPrintable(at + "controller"), wheels[i].controller, "Which controller turns it")
            .range(1, controllerCount);
        add(qPrintable(at + "motor"), wheels[i].motor, "1 for M1, 2 for M2").range(1, 2);
        add(qPrintable(at + "reversed"), wheels[i].reversed, "Positive counts drive the robot backward");
    }
    group("Motion");
    Twist2D &most = s.drive.limits.velocity, &fastest = s.drive.limits.acceleration;
    add("motion.vx", most.vx, "Largest speed forward and back", "m/s", 0.01, 10);
    add("motion.vy", most.vy, "Largest speed sideways", "m/s", 0.01, 10);
    add("motion.omega", most.omega, "Largest rate of turn", "rad/s", 0.01, 20);
    add("motion.ax", fastest.vx, "Largest acceleration forward and back", "m/s^2", 0.01, 20);
    add("motion.ay", fastest.vy, "Largest acceleration sideways", "m/s^2", 0.01, 20);
    add("motion.alpha", fastest.omega, "Largest acceleration of the turn", "rad/s^2", 0.01, 50);
    add("motion.motor_share", motorShare, "Share of pid.qpps up to which the motors are used", "", 0.1, 1);
    group("Safety");
    add("safety.command_timeout_s", s.drive.commandTimeout_s,
        "Without a motion command for so long the robot stops", "s", 0.05, 2);
    add("safety.deceleration", s.emergencyDeceleration, "With which the controllers brake in a stop", "m/s^2",
        0.1, 20);
    group("Odometry");
    add("odometry.position_per_metre", s.odometry.positionPerMetre,
        "Standard deviation of the position after one metre", "m", 0, 1);
    add("odometry.heading_per_metre", s.odometry.headingPerMetre,
        "Standard deviation of the heading after one metre", "rad", 0, 1);
    add("odometry.heading_per_radian", s.odometry.headingPerRadian,
        "Standard deviation of the heading after a turn of one radian", "rad", 0, 1);
    addFaults();
    addBattery();
}

void MotorTable::addFaults() {
    group("Faults");
    add("faults.battery_warning_v", s.battery.warning, "Below it the battery is reported as low", "V", 0, 60);
    add("faults.battery_v", s.battery.fault, "Below it the robot stops", "V", 0, 60);
    add("faults.current_warning_a", s.current.warning, "Above it the current of a motor is reported as high",
        "A", 0, 200);
    add("faults.current_a", s.current.fault, "Above it the robot stops", "A", 0, 200);
    add("faults.temperature_warning_c", s.temperature.warning, "Above it a controller is reported as hot",
        "Cel", 0, 200);
    add("faults.temperature_c", s.temperature.fault, "Above it the robot stops", "Cel", 0, 200);
    add("faults.hold_s", s.battery.hold_s, "How long a value must be beyond", "s", 0, 60);
    add("faults.encoder_commanded_rad_s", s.encoder.commanded,
        "Wheels told to turn slower than this may stand still", "rad/s", 0, 100);
    add("faults.encoder_moving_rad_s", s.encoder.moving, "Wheels slower than this count as standing", "rad/s",
        0.001, 100);
    add("faults.encoder_hold_s", s.encoder.hold_s, "How long a wheel must disobey; longer than braking takes",
        "s", 0, 10);
}

void MotorTable::addBattery() {
    group("Battery");
    add("battery.capacity_ah", s.gauge.capacity_Ah, "Charge of the full battery", "Ah", 0.001, 10000);
    add("battery.full_v", s.gauge.full_v, "Its voltage when it is full and has rested", "V", 1, 60);
    add("battery.empty_v", s.gauge.empty_v, "Its voltage when it is empty and has rested", "V", 0, 60);
    add("battery.idle_a", s.gauge.idle_a,
        "What computers and sensors draw: the controllers do not measure it", "A", 0.01, 100);
    add("battery.reserve", s.gauge.reserve,
        "Share of the charge that is to be left: deep discharge harms lead-acid batteries", "", 0, 0.9);
    add("battery.warning_s", s.batteryWarning_s, "With less time left the battery is reported as low", "s", 0,
        36000);
}

// A device, or a serial server.
bool isLine(const QString &url) {
    const auto parsed = InterfaceUrl::parse(url);
    return parsed && ((parsed->scheme == "serial" && !parsed->path.isEmpty()) ||
                      (parsed->scheme == "tcp" && !parsed->host.isEmpty() && parsed->port != 0));
}

void MotorTable::check() {
    const ControllerAddress &first = s.controllers[0], &second = s.controllers[1];
    for (const ControllerAddress &controller : s.controllers)
        require(isLine(controller.url), controller.url,
                "a line, as serial:///dev/ttyACM0?baud=115200 or, of a serial server, tcp://HOST:PORT");
    require(isArduino() || first.url != second.url || first.address != second.address, second.address,
            "another address than that of controller 1, which is on the same line");
    for (auto wheel = wheels.begin(); wheel != wheels.begin() + driven(); ++wheel)
        require(std::none_of(wheels.begin(), wheel,
                             [wheel](const WheelPlace &other) {
                                 return other.controller == wheel->controller && other.motor == wheel->motor;
                             }),
                wheel->motor, "a motor that turns no other wheel");
    notAbove(s.battery.fault, s.battery.warning);
    require(s.gauge.full_v - s.gauge.empty_v >= 0.1 - rounding_v, s.gauge.full_v,
            "at least 0.1 V more than battery.empty_v");
    notBelow(s.current.fault, s.current.warning);
    notBelow(s.temperature.fault, s.temperature.warning);
    notAbove(s.encoder.moving, s.encoder.commanded);
    checkWatch();
    checkDevices();
}

// What the controllers can do.
void MotorTable::checkDevices() {
    using drive::ArduinoDevice;
    if (!isArduino())
        return require(s.serialTimeout_s <= roboclaw::Device::longestTimeout_s, s.serialTimeout_s,
                       QString("at most %1 s").arg(roboclaw::Device::longestTimeout_s));
    require(s.serialTimeout_s >= ArduinoDevice::timeout_s, s.serialTimeout_s,
            QString("at least %1 s: an Arduino stops by itself no sooner").arg(ArduinoDevice::timeout_s));
    require(layout == "differential", layout, "differential: an Arduino turns two wheels");
    for (int i = 0; i < driven(); ++i)
        require(wheels[i].controller == 1, wheels[i].controller, "1: there is one Arduino");
    const double slowest = s.encoder.commanded * s.countsPerTurn / (2 * vectorlib::pi);
    require(
        slowest >= ArduinoDevice::framesPerSecond, s.encoder.commanded,
        QString("at least %1 rad/s: an Arduino turns its wheels by whole counts in a thirtieth of a second")
            .arg(s.encoder.commanded * ArduinoDevice::framesPerSecond / slowest, 0, 'g', 3));
}

// What watches the wheels sees each motion that matters, in time, and takes no braking for a fault
// (docs/safety.md).
void MotorTable::checkWatch() {
    const auto requireSlow = [&](const double &speed, double rim) {
        require(speed * frame.radius <= rim, speed,
                QString("at most %1 rad/s: %2 m/s at the rim").arg(rim / frame.radius, 0, 'g', 3).arg(rim));
    };
    requireSlow(s.encoder.moving, standingRim);
    requireSlow(s.encoder.commanded, frictionRim);
    require(s.encoder.moving * s.countsPerTurn >= 4 * vectorlib::pi * leastCounts, s.countsPerTurn,
            QString("at least %1: with fewer nothing shows within a second whether a wheel turns with "
                    "faults.encoder_moving_rad_s")
                .arg(4 * vectorlib::pi * leastCounts / s.encoder.moving, 0, 'g', 3));
    // motor.wheels may ask for all that the motors give.
    const double braking = motorShare * s.pid.qpps / s.countsPerTurn * 2 * vectorlib::pi * frame.radius /
                           s.emergencyDeceleration;
    require(s.encoder.hold_s >= braking, s.encoder.hold_s,
            QString("at least the %1 s that braking from the largest speed of a wheel takes")
                .arg(braking, 0, 'g', 3));
    require(s.encoder.hold_s <= braking + longestHold_s, s.encoder.hold_s,
            QString("at most %1 s: %2 s more than braking takes")
                .arg(braking + longestHold_s, 0, 'g', 3)
                .arg(longestHold_s));
}

MotorSettings MotorTable::made() {
    s.wheelRadius = frame.radius;
    s.drive.layout = layout == "mecanum" ? WheelLayout::mecanum(frame) : WheelLayout::differential(frame);
    s.drive.limits.wheelSpeed = motorShare * s.pid.qpps * 2 * vectorlib::pi / s.countsPerTurn;
    std::transform(wheels.begin(), wheels.end(), s.wheels.begin(), [](const WheelPlace &wheel) {
        return WheelMount{wheel.controller - 1, wheel.motor - 1, wheel.reversed ? -1.0 : 1.0};
    });
    if (isArduino()) {
        s.controllers.resize(1);
        s.controllers[0].kind = DeviceKind::Arduino;
        std::copy_n(s.wheels.begin(), 2, s.wheels.begin() + 2); // behind: as in front
    }
    s.current.hold_s = s.temperature.hold_s = s.battery.hold_s;
    s.encoder.deceleration = s.emergencyDeceleration / s.wheelRadius / 2; // motors lag behind
    return s;
}

} // namespace

void declareMotorSettings(const std::function<void(const Field &)> &declare) {
    MotorTable().declare(declare);
}

std::vector<SchemaViolation> checkMotorSettings(const QJsonObject &settings) {
    MotorTable table(settings);
    table.check();
    return table.violations();
}

MotorSettings MotorSettings::from(const Settings &settings) {
    return MotorTable(settings.inForce()).made();
}

} // namespace hermes::motorcontrol
