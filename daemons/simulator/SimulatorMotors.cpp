#include "common/Log.h"
#include "daemons/simulator/Simulator.h"
#include "daemons/simulator/SimulatorMessages.h"

namespace hermes::simulator {

namespace {

void applyFault(MotorEmulator &controller, const Call &call) {
    const std::string kind = call.text("kind").toStdString();
    const bool share = kind == "loss" || kind == "corrupt";
    if (kind == "none")
        controller.faults() = {};
    else
        controller.setFault(kind, kind == "restart" ? ArduinoEmulator::restartTime
                                                    : call.number(share ? "share" : "delay_s"));
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
            applyFault(drivetrain.controller(second), call);
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
    for (int i = 0; i < drivetrain.controllers(); ++i) {
        const MotorEmulator &c = drivetrain.controller(i);
        state.controllers->push_back({c.status(), c.temperature(), c.timeout(), c.counts()});
    }
    state.battery_v = drivetrain.battery().voltage();
    state.batteryCharge = drivetrain.battery().charge();
    return state;
}

} // namespace hermes::simulator
