#include "common/Log.h"
#include "daemons/simulator/Simulator.h"
#include "daemons/simulator/SimulatorMessages.h"

namespace hermes::simulator {

namespace {

void applyFault(RoboClawEmulator &controller, const Call &call) {
    RoboClawEmulator::Faults &faults = controller.faults();
    const QString kind = call.text("kind");
    if (kind == "none")
        faults = {};
    else if (kind == "silence")
        faults.silent = true;
    else if (kind == "loss")
        faults.drop = call.number("share");
    else if (kind == "corrupt")
        faults.corrupt = call.number("share");
    else if (kind == "slow")
        faults.delay = call.number("delay_s");
    else if (kind == "deaf")
        faults.deaf = true;
    else if (kind == "mute")
        faults.drop = 1;
    else if (kind == "latched")
        faults.latched = true;
    else if (kind == "echo")
        faults.echo = true;
    else if (kind == "stuck_timeout")
        faults.stuckTimeout = true;
    else if (kind == "brownout")
        controller.restart(call.number("delay_s"));
    else if (kind == "emergency_stop")
        faults.status |= roboclaw::EmergencyStop;
    else if (kind == "over_temperature")
        faults.status |= roboclaw::TemperatureError;
    else if (kind == "over_current")
        faults.status |= roboclaw::OverCurrentWarningM1 | roboclaw::OverCurrentWarningM2;
    else if (kind == "driver")
        faults.status |= roboclaw::DriverFaultM1;
}

void applyFault(MotorChannel &motor, const Call &call) {
    const QString kind = call.text("kind");
    if (kind == "jump")
        return motor.jump(call.integer("counts"));
    motor.setBlocked(kind == "blocked");
    motor.setEncoderBroken(kind == "encoder");
    motor.setEncoderBackward(kind == "backward");
}

} // namespace

void Simulator::declareMotorSettings() {
    addSetting(Field::text("motors.link",
                           "Link to the pseudo-terminal of the motor controllers; none: sim.state "
                           "tells its name")
                   .byDefault("")
                   .appliesOnRestart()
                   .group("Motors"));
    addSetting(
        Field::text("motors.link2", "Link to one of its own for the second controller; none: both share one")
            .byDefault("")
            .appliesOnRestart()
            .group("Motors"));
    for (const int controller : {1, 2}) {
        addSetting(
            Field::integer(QString("motors.address%1").arg(controller), "Of this controller on its line")
                .range(roboclaw::firstAddress, roboclaw::lastAddress)
                .byDefault(roboclaw::firstAddress + controller - 1)
                .appliesOnRestart()
                .group("Motors"));
    }
    addSetting(
        Field::text(
            "motors.firmware",
            "Of the controllers: 4.1.28 tells its status in 16 bits, 4.3.6 does not know commands 0 to 13")
            .choices(QStringList(RoboClawEmulator::firmwareVersions.begin(),
                                 RoboClawEmulator::firmwareVersions.end()))
            .byDefault("4.2.8")
            .appliesOnRestart()
            .group("Motors"));
    addNumber("Motors", "motors.full_speed", "Encoder counts a second at full duty and 24 V", "1/s", 100, 2e7,
              160000);
    addNumber("Motors", "motors.lag_s", "Time constant with which a wheel follows", "s", 0.001, 10, 0.02);
    addNumber("Motors", "battery.capacity_ah", "Charge of the battery", "Ah", 0.001, 10000, 26);
    addNumber("Motors", "battery.full_v", "Its voltage when full, without load", "V", 0, 34, 25.4);
    addNumber("Motors", "battery.empty_v",
              "Its voltage when empty, without load; below 5 % of the charge it falls to 20 V", "V", 0, 34,
              23.4);
    addSetting(Field::text("frame.layout", "How the wheels move the robot")
                   .choices({"mecanum", "differential"})
                   .byDefault("mecanum")
                   .appliesOnRestart()
                   .group("Wheels"));
    addNumber("Wheels", "frame.wheel_radius_m", "Radius of a wheel", "m", 0.01, 1, 0.1);
    addNumber("Wheels", "frame.half_base_m", "From the centre to an axle", "m", 0.01, 5, 0.25);
    addNumber("Wheels", "frame.half_track_m", "From the centre to the middle of a wheel", "m", 0.01, 5, 0.25);
    addNumber("Wheels", "frame.counts_per_turn", "Encoder counts in one turn of a wheel", "", 1, 1e7, 38000);
    addNumber("Wheels", "frame.slip", "Share of the wheels' way that the robot does not make", "", 0, 1, 0);
    addNumber("Wheels", "frame.slip_spread",
              "Standard deviation of each wheel's slip, drawn anew for each metre it rolls", "", 0, 1, 0);
}

Drivetrain::Options Simulator::drivetrainOptions() {
    const Settings &values = settings();
    Drivetrain::Options options;
    const bool mecanum = values.text("frame.layout") == "mecanum";
    options.base.kind = mecanum ? WheelBase::Kind::Mecanum : WheelBase::Kind::Differential;
    options.base.radius = values.number("frame.wheel_radius_m");
    options.base.halfBase = values.number("frame.half_base_m");
    options.base.halfTrack = values.number("frame.half_track_m");
    options.countsPerTurn = values.number("frame.counts_per_turn");
    options.slip = values.number("frame.slip");
    options.slipSpread = values.number("frame.slip_spread");
    options.seed = std::uint64_t(values.number("seed"));
    options.ownLines = lines_.count() > 1;
    options.battery.capacity_Ah = values.number("battery.capacity_ah");
    options.battery.full = values.number("battery.full_v");
    options.battery.empty = values.number("battery.empty_v");
    for (std::size_t i = 0; i < options.controller.size(); ++i) {
        RoboClawEmulator::Options &controller = options.controller[i];
        controller.address = std::uint8_t(values.integer(QString("motors.address%1").arg(i + 1)));
        controller.setFirmware(values.text("motors.firmware").toStdString());
        controller.motor.fullSpeed = values.number("motors.full_speed");
        controller.motor.lag = values.number("motors.lag_s");
        controller.seed = std::uint64_t(values.number("seed")) + i;
    }
    return options;
}

Result<QJsonValue> Simulator::setMotorFault(const Call &call) {
    const QString device = call.text("device"), kind = call.text("kind");
    const bool second = device.endsWith('2');
    if (device.startsWith("line")) {
        if (second && lines_.count() < 2)
            return Error(ErrorCode::NotReady,
                         "both controllers share line1; motors.link2 makes a second one");
        if (kind != "adapter")
            lines_.setPulled(second, kind == "pulled");
    } else if (worldPath_.isEmpty()) {
        return Error(ErrorCode::NotReady, "no world is loaded; sim.load loads one");
    }
    pump_.with([&](Simulation &simulation) {
        Drivetrain &drivetrain = simulation.drivetrain();
        if (device.startsWith("line"))
            drivetrain.setLatency(second, kind == "adapter" ? call.number("delay_s") : 0);
        else if (device == "controllers")
            drivetrain.setSwapped(kind == "swapped");
        else if (device.startsWith("controller"))
            applyFault(drivetrain.controller(second), call);
        else if (device == "battery")
            drivetrain.battery().setCharge(kind == "none" ? 1 : call.number("share"));
        else if (device == "wheels")
            drivetrain.setSlip(kind == "none" ? settings().number("frame.slip") : call.number("share"));
        else if (const int wheel = wheelNumber(device); wheel >= 0)
            applyFault(drivetrain.wheel(wheel), call);
    });
    logInfo("simulator", QString("fault of %1: %2").arg(device, kind));
    return QJsonValue();
}

DrivetrainState Simulator::motorState(Drivetrain &drivetrain) const {
    DrivetrainState state;
    state.wheels_rps = drivetrain.wheelSpeeds();
    state.controllers.emplace();
    for (int i = 0; i < Drivetrain::controllers; ++i) {
        const RoboClawEmulator &c = drivetrain.controller(i);
        state.controllers->push_back({c.status(), c.temperature(), c.serialTimeout(), c.counts()});
    }
    state.battery_v = drivetrain.battery().voltage();
    state.batteryCharge = drivetrain.battery().charge();
    return state;
}

} // namespace hermes::simulator
