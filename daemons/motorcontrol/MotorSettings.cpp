#include "daemons/motorcontrol/MotorSettings.h"

#include "common/interface/InterfaceUrl.h"
#include "common/settings/SettingsTable.h"
#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <set>

namespace hermes::motorcontrol {
namespace {

constexpr double rounding_v = 1e-9; // of differences of decimal fractions
// Speeds of the rim in m/s: what may count as standing, and be given up to friction.
constexpr double standingRim = 0.05, frictionRim = 0.1;
constexpr double slowestShare = 1.2; // of what the controllers cannot turn slower, it may be given up, too
constexpr double leastCounts = 2;    // a second, of a wheel that turns: one may be jitter
constexpr double longestHold_s = 1;  // beyond braking
constexpr double largestUnstopped = 0.3; // m/s, where nothing stops the robot when this program dies

/// Where people mount a wheel.
struct WheelPlace {
    int controller, motor; ///< 1 or 2
    bool reversed = false;
};

/// The settings, and what is checked and made of them.
struct MotorTable : SettingsTable {
    MotorSettings s;
    QString kind = deviceModels().front().name, layout = "mecanum";
    int controllerNumber = 0, rearMotors = 1;
    WheelGeometry frame;
    std::array<WheelPlace, wheelCount> wheels{{{1, 1}, {1, 2}, {2, 1}, {2, 2}}};
    double motorShare = 0.95;

    MotorTable();
    explicit MotorTable(const QJsonObject &settings)
        : MotorTable() {
        read(settings);
        s.wheelRadius = frame.radius;
        s.halfTrack = frame.halfTrack;
    }
    void check();
    MotorSettings made();

private:
    void addFaults();
    void addBattery();
    void checkWatch();
    void checkDevices();
    void checkWheels();
    void checkSteering();
    const DeviceModel &model() const { return deviceModel(kind.toStdString()); }
    /// Slower (rad/s) the controllers cannot turn the wheels.
    double slowest() const { return model().slowest(s.device()) * 2 * vectorlib::pi / s.countsPerTurn; }
    WheelLayout wheelLayout() const;
    /// One controller turns four wheels: those behind have no motor of their own.
    bool isRearAsFront() const {
        return layout == "differential" && (model().most == 1 || controllerNumber == 1);
    }
    /// The wheels that have a motor of their own.
    std::vector<const WheelPlace *> driven() const;
    /// As those name them: the largest number.
    int neededControllers() const;
};

MotorTable::MotorTable() {
    group("Controllers");
    QStringList kinds, abouts;
    for (const DeviceModel &each : deviceModels()) {
        kinds.append(each.name);
        abouts.append(each.about);
    }
    add("controllers.kind", kind, qPrintable("What they are: " + abouts.join(", ")))
        .choices(kinds)
        .appliesOnRestart();
    add("controllers.count", controllerNumber,
        "How many there are; 0: as many as the wheels name. With 1, the wheels behind of differential turn "
        "as "
        "those in front")
        .range(0, controllerCount)
        .appliesOnRestart();
    for (int i = int(s.controllers.size()); i < controllerCount; ++i)
        s.controllers.push_back({roboclaw::usualLine, roboclaw::firstAddress + i});
    for (int i = 0; i < controllerCount; ++i) {
        const QString at = QString("controllers.%1.").arg(i + 1);
        add(qPrintable(at + "url"), s.controllers[i].url,
            i == 0 ? "Its serial line, as serial:///dev/ttyACM0?baud=115200; controllers with the same URL "
                     "share the line"
                   : "Its serial line; see controllers.1.url")
            .appliesOnRestart();
        add(qPrintable(at + "address"), s.controllers[i].address,
            "Its address on the line, of a RoboClaw; of VESCs the CAN id of the second one, 255: there is "
            "none")
            .range(0, 255)
            .appliesOnRestart();
    }
    add("controllers.timeout_s", s.serialTimeout_s,
        "Without a command for so long the controllers stop by themselves; an Arduino needs 2 s, an OpenCR "
        "0.5 s",
        "s", 0.1, 2)
        .step(0.1);
    add("controllers.brake_a", s.brake_a, "With which a VESC brakes each motor that is told to stand", "A",
        0.1, 200);
    add("controllers.least_erpm", s.leastErpm,
        "Electrical turns a minute below which a VESC would release its motors; they brake then", "1/min", 0,
        20000);
    group("PID");
    add("pid.p", s.pid.p, "Proportional part of the controllers' velocity control", "", 0, 1000);
    add("pid.i", s.pid.i, "Integral part", "", 0, 1000);
    add("pid.d", s.pid.d, "Differential part", "", 0, 1000);
    add("pid.qpps", s.pid.qpps, "Encoder counts a second at full duty", "1/s", 100, 20000000);
    group("Wheels");
    add("frame.layout", layout, "How the wheels move the robot")
        .choices({"mecanum", "differential", "two_wheels", "omni3", "omni4", "ackermann"});
    add("frame.wheel_radius_m", frame.radius, "Radius of a wheel", "m", 0.01, 1);
    add("frame.half_base_m", frame.halfBase, "From the centre to an axle, along x", "m", 0.01, 5);
    add("frame.half_track_m", frame.halfTrack, "From the centre to the middle of a wheel, along y", "m", 0.01,
        5);
    add("frame.omni_radius_m", frame.omniRadius, "Of omni3 and omni4: from the centre to a wheel", "m", 0.01,
        5);
    add("frame.omni_angle_rad", frame.omniAngle,
        "Of omni3 and omni4: where front_left is, counter-clockwise from x; the others follow evenly", "rad",
        -6.3, 6.3);
    add("frame.rear_motors", rearMotors, "Of ackermann: 1 for both wheels behind, or one each").range(1, 2);
    add("frame.steering_rad", frame.largestSteering, "Of ackermann: largest steering angle", "rad", 0.01,
        1.5);
    add("frame.steering_rate_rad_s", s.drive.limits.steeringRate, "How fast its servo turns it", "rad/s",
        0.01, 100);
    add("frame.servo_centre", s.servoCentre, "Position of its servo, 0 to 1, straight ahead", "", 0, 1);
    add("frame.servo_per_rad", s.servoPerRadian, "How far its servo goes for a radian to the left", "1/rad",
        -100, 100);
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
    add("safety.no_device_timeout", s.mayLackTimeout,
        "Drives controllers that never stop by themselves, too: when this program dies the robot drives on");
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
    const bool areEnough = driven().size() <= 2 * std::size_t(model().most);
    require(areEnough, layout, QString("differential or two_wheels: %1 turns two wheels").arg(model().title));
    if (!areEnough)
        return; // all else follows from it
    for (int i = 0; i < neededControllers(); ++i) {
        const ControllerAddress &one = s.controllers[std::size_t(i)];
        require(isLine(one.url), one.url,
                QString("a line, as serial:///dev/ttyACM0?baud=%1 or, of a serial server, tcp://HOST:PORT")
                    .arg(model().baud));
        for (int k = 0; k < i; ++k) {
            const ControllerAddress &other = s.controllers[std::size_t(k)];
            if (one.url != other.url)
                continue;
            require(model().address.sharesLine, one.url,
                    QString("another line than that of controller %1").arg(k + 1));
            require(
                one.address != other.address, one.address,
                QString("another address than that of controller %1, which is on the same line").arg(k + 1));
        }
    }
    checkWheels();
    checkSteering();
    notAbove(s.battery.fault, s.battery.warning);
    require(s.gauge.full_v - s.gauge.empty_v >= 0.1 - rounding_v, s.gauge.full_v,
            "at least 0.1 V more than battery.empty_v");
    notBelow(s.current.fault, s.current.warning);
    notBelow(s.temperature.fault, s.temperature.warning);
    notAbove(s.encoder.moving, s.encoder.commanded);
    checkWatch();
    checkDevices();
}

WheelLayout MotorTable::wheelLayout() const {
    return layout == "mecanum"        ? WheelLayout::mecanum(frame)
           : layout == "differential" ? WheelLayout::differential(frame)
           : layout == "two_wheels"   ? WheelLayout::twoWheels(frame)
           : layout == "ackermann"    ? WheelLayout::ackermann(frame, rearMotors)
                                      : WheelLayout::omni(frame, layout == "omni3" ? 3 : 4);
}

std::vector<const WheelPlace *> MotorTable::driven() const {
    std::vector<const WheelPlace *> driven;
    for (int i = 0; i < (isRearAsFront() ? 2 : wheelCount); ++i) {
        if (wheelLayout().has(i))
            driven.push_back(&wheels[std::size_t(i)]);
    }
    return driven;
}

int MotorTable::neededControllers() const {
    int needed = 1;
    for (const WheelPlace *wheel : driven())
        needed = std::max(needed, wheel->controller);
    return needed;
}

void MotorTable::checkWheels() {
    std::set<std::pair<int, int>> motors;
    std::set<int> numbers;
    const auto driven = this->driven();
    for (const WheelPlace *wheel : driven) {
        require(motors.emplace(wheel->controller, wheel->motor).second, wheel->motor,
                "a motor that turns no other wheel");
        numbers.insert(wheel->controller);
    }
    const int needed = neededControllers();
    for (const WheelPlace *wheel : driven)
        require(wheel->controller <= model().most, wheel->controller,
                QString("at most %1: a robot has no more of its kind of controller").arg(model().most));
    require(int(numbers.size()) == needed, driven.back()->controller,
            "numbers without a gap: a wheel for each controller from 1 on");
    require(controllerNumber == 0 || controllerNumber == needed, controllerNumber,
            QString("0 or %1: so many turn wheels").arg(needed));
}

void MotorTable::checkSteering() {
    if (layout != "ackermann")
        return;
    require(
        model().turnsServo, layout,
        QString("another layout, or controllers.kind=vesc: %1 has no output for a servo").arg(model().title));
    const double reach = std::abs(s.servoPerRadian) * frame.largestSteering;
    const double room = std::min(s.servoCentre, 1 - s.servoCentre);
    require(reach > 0 && reach <= room + rounding_v, s.servoPerRadian,
            QString("not 0, and at most %1 either way: with frame.steering_rad the servo stays within 0 to 1")
                .arg(room / frame.largestSteering, 0, 'g', 3));
}

// What the controllers can do.
void MotorTable::checkDevices() {
    const DeviceModel &device = model();
    require(s.serialTimeout_s <= device.timeout.latest_s, s.serialTimeout_s,
            QString("at most %1 s: %2 is not driven with a longer one")
                .arg(device.timeout.latest_s)
                .arg(device.title));
    require(s.serialTimeout_s >= device.timeout.soonest_s, s.serialTimeout_s,
            QString("at least %1 s: %2 stops by itself no sooner")
                .arg(device.timeout.soonest_s)
                .arg(device.title));
    for (int i = 0; i < neededControllers() && device.address.text; ++i)
        require(s.controllers[i].address >= device.address.first &&
                    s.controllers[i].address <= device.address.last,
                s.controllers[i].address,
                QString("from %1 to %2, for %3")
                    .arg(device.address.first)
                    .arg(device.address.last)
                    .arg(device.title));
    require(device.timeout.mayBeNone || !s.mayLackTimeout, s.mayLackTimeout,
            QString("false: %1 has a time-out").arg(device.title));
    require(!s.mayLackTimeout || s.drive.limits.velocity.vx <= largestUnstopped, s.drive.limits.velocity.vx,
            QString("at most %1 m/s with safety.no_device_timeout").arg(largestUnstopped));
    for (const WheelPlace *wheel : driven()) {
        const int address = s.controllers[std::size_t(wheel->controller) - 1].address;
        require(wheel->motor == 1 || address != device.address.alone, wheel->motor,
                QString("1: with address %1 %2 turns no second motor").arg(address).arg(device.title));
    }
    require(s.encoder.commanded >= slowest(), s.encoder.commanded,
            QString("at least %1 rad/s: %2 turns its wheels no slower")
                .arg(slowest(), 0, 'g', 3)
                .arg(device.title));
}

// What watches the wheels sees each motion that matters, in time, and takes no braking for a fault
// (docs/safety.md).
void MotorTable::checkWatch() {
    const auto requireSlow = [&](const double &speed, double rim) {
        require(speed * frame.radius <= rim, speed,
                QString("at most %1 rad/s: %2 m/s at the rim").arg(rim / frame.radius, 0, 'g', 3).arg(rim));
    };
    requireSlow(s.encoder.moving, standingRim);
    requireSlow(s.encoder.commanded, std::max(frictionRim, slowestShare * slowest() * frame.radius));
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
    s.drive.layout = wheelLayout();
    double &fastest = s.drive.limits.wheelSpeed;
    fastest = motorShare * s.pid.qpps * 2 * vectorlib::pi / s.countsPerTurn;
    if (s.mayLackTimeout) // sideways, and by motor.wheels, too
        fastest = std::min(fastest, largestUnstopped / s.wheelRadius);
    std::transform(wheels.begin(), wheels.end(), s.wheels.begin(), [](const WheelPlace &wheel) {
        return WheelMount{wheel.controller - 1, wheel.motor - 1, wheel.reversed ? -1.0 : 1.0};
    });
    s.controllers.resize(std::size_t(neededControllers()));
    for (ControllerAddress &controller : s.controllers)
        controller.model = &model();
    s.drive.rearAsFront = isRearAsFront();
    if (s.drive.rearAsFront)
        std::copy_n(s.wheels.begin(), 2, s.wheels.begin() + 2);
    for (int i = 0; i < wheelCount; ++i) {
        if (!s.drive.layout.has(i))
            s.wheels[std::size_t(i)] = WheelMount::none();
    }
    s.current.hold_s = s.temperature.hold_s = s.battery.hold_s;
    s.encoder.deceleration = s.emergencyDeceleration / s.wheelRadius / 2; // motors lag behind
    return s;
}

} // namespace

void declareMotorSettings(Settings &settings) {
    MotorTable().declareIn(settings);
}

std::vector<SchemaViolation> checkMotorSettings(const QJsonObject &settings) {
    MotorTable table(settings);
    table.check();
    return table.violations();
}

MotorSettings MotorSettings::from(const Settings &settings) {
    return MotorTable(settings.inForce()).made();
}

MotorSettings MotorSettings::withWaiting(const Settings &settings) {
    return MotorTable(settings.values()).made();
}

} // namespace hermes::motorcontrol
