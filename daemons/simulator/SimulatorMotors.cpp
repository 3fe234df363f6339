#include "common/Log.h"
#include "daemons/simulator/Simulator.h"
#include "daemons/simulator/SimulatorMessages.h"

namespace hermes::simulator {

namespace {

void applyFault(Drivetrain &drivetrain, int number, const Call &call) {
    auto &arduino = drivetrain.arduino();
    RoboClawEmulator &controller = drivetrain.controller(number);
    RoboClawEmulator::Faults &faults = arduino ? arduino->faults() : controller.faults();
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
    else if (kind == "restart")
        arduino->restart();
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

Result<void> Simulator::setMotorFault(const Call &call) {
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
            applyFault(drivetrain, second, call);
        else if (device == "battery")
            drivetrain.battery().setCharge(kind == "none" ? 1 : call.number("share"));
        else if (device == "wheels")
            drivetrain.setSlip(kind == "none" ? settings().number("frame.slip") : call.number("share"));
        else if (const int wheel = wheelNumber(device); wheel >= 0)
            applyFault(drivetrain.wheel(wheel), call);
    });
    logInfo("simulator", QString("fault of %1: %2").arg(device, kind));
    return {};
}

DrivetrainState Simulator::motorState(Drivetrain &drivetrain) const {
    DrivetrainState state;
    state.wheels_rps = drivetrain.wheelSpeeds();
    state.controllers.emplace();
    if (const auto &arduino = drivetrain.arduino())
        state.controllers->push_back({{}, {}, arduino->timeout(), arduino->counts()});
    for (int i = 0; i < Drivetrain::controllers && !drivetrain.arduino(); ++i) {
        const RoboClawEmulator &c = drivetrain.controller(i);
        state.controllers->push_back({c.status(), c.temperature(), c.serialTimeout(), c.counts()});
    }
    state.battery_v = drivetrain.battery().voltage();
    state.batteryCharge = drivetrain.battery().charge();
    return state;
}

} // namespace hermes::simulator
