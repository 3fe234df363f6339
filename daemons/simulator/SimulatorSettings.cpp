#include "daemons/simulator/SimulatorSettings.h"

namespace hermes::simulator {

namespace {

/// In the order of WheelBase::Kind.
QStringList layouts() {
    return {"mecanum", "differential", "two_wheels", "omni3", "omni4", "ackermann"};
}

} // namespace

SimulatorSettings::SimulatorSettings() {
    Simulation::Options &robot = simulation;
    LidarModel::Options &lidar = simulation.lidar;
    group("World", Applies::OnRestart);
    add("world", world, "World file to load at the start; empty: none until sim.load");
    add("seed", robot.seed, "Of the noise: the same seed gives the same noise").range(0, 4294967295.0);
    add("wall_height_m", lidar.wallHeight, "Height of the walls; beams above them return nothing", "m", 0.01,
        100);
    group("Robot", Applies::OnRestart);
    add("robot.speed_mps", robot.speed, "Largest speed along the path", "m/s", 0.01, 20);
    add("robot.acceleration_mps2", robot.acceleration, "When speeding up and slowing down", "m/s^2", 0.01,
        50);
    add("robot.turn_rate_rps", robot.turnRate, "Largest turn rate", "rad/s", 0.01, 20);
    add("robot.radius_m", robot.radius, "Of its outline, which walls stop", "m", 0.01, 5);
    add("robot.autostart", autostart, "Follow the path at once, without sim.drive");
    group("Lidar", Applies::OnRestart);
    add("lidar.host", lidarHost, "IPv4 address that packets are sent to");
    add("lidar.port", lidarPort, "UDP port that packets are sent to; 0: the lidar is off").range(0, 65535);
    add("lidar.position_port", positionPort, "UDP port that position packets are sent to; 0: none are")
        .range(0, 65535);
    add("lidar.rpm", robot.rpm, "Turns of the head a minute", "1/min", 300, 1200);
    add("lidar.height_m", lidar.sensorHeight, "Of the sensor above the floor", "m", 0.01, 10);
    add("lidar.min_range_m", lidar.minRange, "Nearer things return nothing", "m", 0, 10);
    add("lidar.max_range_m", lidar.maxRange, "Farther things return nothing", "m", 1, 131);
    add("lidar.gps", robot.lidarGps, "A GPS sets its clock; without, that counts from anywhere");
    add("lidar.clock_s", robot.lidarClock_s, "Of a clock without GPS: ahead of this host's at the start", "s",
        0, 3600);
    add("lidar.drift_ppm", robot.lidarDrift_ppm, "Of a clock without GPS: how much faster it goes", "ppm",
        -1000, 1000);
    group("Lidar");
    add("lidar.sigma_m", lidar.sigma, "Standard deviation of the range", "m", 0, 1);
    add("lidar.dropouts", lidar.dropouts, "Share of the returns that do not come").range(0, 1);
    add("lidar.outliers", lidar.outliers, "Share of the returns with a wrong range, up to twice as far")
        .range(0, 1);
    addMotors();
    addGps();
    addScanner();
}

void SimulatorSettings::addMotors() {
    Drivetrain::Options &drivetrain = simulation.drivetrain;
    MotorChannel::Motor &motor = drivetrain.controller[0].motor;
    group("Motors", Applies::OnRestart);
    QStringList kinds;
    for (const MotorKind &kind : motorKinds())
        kinds.append(kind.name);
    add("motors.kind", motorsKind,
        "What drives the wheels: two RoboClaws, or one of the others, with two motors")
        .choices(kinds);
    add("motors.link", link,
        "Link to the pseudo-terminal of the motor controllers; none: sim.state tells its name");
    add("motors.link2", link2, "Link to one of its own for the second controller; none: both share one");
    for (std::size_t i = 0; i < drivetrain.controller.size(); ++i)
        add(qPrintable(QString("motors.address%1").arg(i + 1)), drivetrain.controller[i].address,
            "Of this controller on its line")
            .range(roboclaw::firstAddress, roboclaw::lastAddress);
    const auto &versions = RoboClawEmulator::firmwareVersions;
    add("motors.firmware", firmware,
        "Of the controllers: 4.1.28 tells its status in 16 bits, 4.3.6 does not know commands 0 to 13")
        .choices(QStringList(versions.begin(), versions.end()));
    add("motors.arduino.timeout_s", drivetrain.arduino.timeout,
        "Of its firmware: after so long without a command that drives, the power is off", "s", 0.05, 600);
    add("motors.arduino.coasts", drivetrain.arduino.coasts, "Without power its wheels roll; else they brake");
    add("motors.vesc.can_id", drivetrain.vesc.ids[1],
        "Of the second VESC, which turns the right wheels; 255: there is none")
        .range(0, 255);
    add("motors.vesc.timeout_s", drivetrain.vesc.timeout,
        "After so long without a command that drives it, each brakes or coasts; 0: never", "s", 0, 600);
    add("motors.vesc.brake_current_a", drivetrain.vesc.brakeCurrent,
        "With which they brake then; with 0 they coast", "A", 0, 200);
    add("motors.full_speed", motor.fullSpeed, "Encoder counts a second at full duty and 24 V", "1/s", 100,
        2e7);
    add("motors.lag_s", motor.lag, "Time constant with which a wheel follows", "s", 0.001, 10);
    add("battery.capacity_ah", drivetrain.battery.capacity_Ah, "Charge of the battery", "Ah", 0.001, 10000);
    add("battery.full_v", drivetrain.battery.full, "Its voltage when full, without load", "V", 0, 34);
    add("battery.empty_v", drivetrain.battery.empty,
        "Its voltage when empty, without load; below 5 % of the charge it falls to 20 V", "V", 0, 34);
    group("Wheels", Applies::OnRestart);
    add("frame.layout", layout, "How the wheels move the robot").choices(layouts());
    add("frame.wheel_radius_m", drivetrain.base.radius, "Radius of a wheel", "m", 0.01, 1);
    add("frame.half_base_m", drivetrain.base.halfBase, "From the centre to an axle", "m", 0.01, 5);
    add("frame.half_track_m", drivetrain.base.halfTrack, "From the centre to the middle of a wheel", "m",
        0.01, 5);
    WheelBase &base = drivetrain.base;
    add("frame.omni_radius_m", base.omniRadius, "Of omni3 and omni4: from the centre to a wheel", "m", 0.01,
        5);
    add("frame.omni_angle_rad", base.omniAngle,
        "Of omni3 and omni4: where front_left is, counter-clockwise from x; the others follow evenly", "rad",
        -6.3, 6.3);
    add("frame.rear_motors", base.rearMotors, "Of ackermann: M1 for both wheels behind, or M1 and M2")
        .range(1, 2);
    add("frame.servo_centre", base.servoCentre, "Position of its servo, 0 to 1, straight ahead", "", 0, 1);
    add("frame.servo_per_rad", base.servoPerRadian, "How far its servo goes for a radian to the left",
        "1/rad", -100, 100);
    add("frame.counts_per_turn", drivetrain.countsPerTurn, "Encoder counts in one turn of a wheel", "", 1,
        1e7);
    add("frame.slip", drivetrain.slip, "Share of the wheels' way that the robot does not make", "", 0, 1);
    add("frame.slip_spread", drivetrain.slipSpread,
        "Standard deviation of each wheel's slip, drawn anew for each metre it rolls", "", 0, 1);
}

void SimulatorSettings::addGps() {
    GpsModel::Options &gps = simulation.gps;
    group("GPS", Applies::OnRestart);
    add("gps.link", gpsLink,
        "Link to the pseudo-terminal of the GPS receiver; none: sim.state tells its name");
    add("gps.rate_hz", gps.rate_hz, "Fixes a second", "Hz", 1, 10);
    add("gps.latitude_deg", gps.origin.latitude_deg,
        "Of the world's origin, north positive; x points east, y north", "deg", -89, 89);
    add("gps.longitude_deg", gps.origin.longitude_deg, "Of the world's origin, east positive", "deg", -180,
        180);
    add("gps.altitude_m", gps.altitude, "Of the receiver above the sea", "m", -500, 9000);
    group("GPS");
    add("gps.sigma_m", gps.sigma, "Standard deviation of each coordinate of a fix", "m", 0, 1000);
}

void SimulatorSettings::addScanner() {
    QStringList models{"none"};
    for (const ScannerModel &model : scannerModels())
        models.append(model.name);
    group("Scanner", Applies::OnRestart);
    add("scanner.model", scannerModel, "A 2D laser scanner besides").choices(models);
    add("scanner.link", scannerLink,
        "Link to the pseudo-terminal of the scanner; none: sim.state tells its name");
    add("scanner.port", scannerPort, "TCP port of 127.0.0.1 on which it listens; 0: it is on a serial line")
        .range(0, 65535);
    add("scanner.x_m", simulation.scannerPose.x, "Where it is on the robot, forward", "m", -10, 10);
    add("scanner.y_m", simulation.scannerPose.y, "Where it is on the robot, to the left", "m", -10, 10);
    add("scanner.theta_rad", simulation.scannerPose.theta, "Direction of its zero, counter-clockwise", "rad",
        -6.3, 6.3);
    add("scanner.drift_ppm", simulation.scanner.drift_ppm, "How much faster its clock goes, if it has one",
        "ppm", -1000, 1000);
}

SimulatorSettings::SimulatorSettings(const QJsonObject &settings)
    : SimulatorSettings() {
    read(settings);
    Drivetrain::Options &drivetrain = simulation.drivetrain;
    const std::string kindName = motorsKind.toStdString();
    const MotorKind &kind = motorKind(kindName);
    WheelBase &base = drivetrain.base;
    base.kind = WheelBase::Kind(layouts().indexOf(layout));
    const bool isForTwo = layout == "differential" || layout == "two_wheels", isCar = layout == "ackermann";
    require(kind.controllers > 1 || isForTwo || isCar, layout,
            QString("differential or two_wheels: the wheels have %1 with two motors").arg(kind.title));
    require(!isCar || motorsKind == "vesc", layout,
            QString("another layout, or motors.kind=vesc: %1 turns no steering servo").arg(kind.title));
    require(base.servoPerRadian != 0, base.servoPerRadian, "not 0");
    require(kind.controllers > 1 || link2.isEmpty(), link2,
            QString("empty: there is one line to %1").arg(kind.title));
    require(motorsKind != "opencr" || drivetrain.countsPerTurn == OpenCrEmulator::countsPerTurn,
            drivetrain.countsPerTurn, "4096: so many an OpenCR counts");
    if (base.kind == WheelBase::Kind::Ackermann) { // its motors are those of the first controller
        drivetrain.wheels[2] = {0, 0};
        drivetrain.wheels[3] = {0, base.rearMotors - 1};
    }
    drivetrain.kind = kind.name;
    drivetrain.seed = simulation.gps.seed = simulation.scanner.seed = simulation.seed;
    simulation.scannerModel = scannerModel.toStdString();
    for (MotorEmulator::Options *options : std::initializer_list<MotorEmulator::Options *>{
             &drivetrain.arduino, &drivetrain.vesc, &drivetrain.openCr, &drivetrain.roboteq})
        *options = {drivetrain.controller[0].motor, simulation.seed};
    drivetrain.openCr.wheelRadius = drivetrain.base.radius;
    drivetrain.openCr.halfTrack = drivetrain.base.halfTrack;
    drivetrain.controller[1].motor = drivetrain.controller[0].motor;
    for (std::size_t i = 0; i < drivetrain.controller.size(); ++i) {
        drivetrain.controller[i].setFirmware(firmware.toStdString());
        drivetrain.controller[i].seed = simulation.seed + i;
    }
}

} // namespace hermes::simulator
