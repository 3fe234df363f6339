#include "daemons/motorcontrol/MotorMessages.h"

#include "common/Time.h"
#include "daemons/motorcontrol/DriveLoop.h"
#include "protocol/roboclaw/Status.h"
#include "protocol/wire/Fields.h"

#include <algorithm>

namespace hermes {

// A struct of the protocol: its fields are looked for here.
Fields<drive::Bus::Counts> fieldsOf(Of<drive::Bus::Counts>) {
    using C = drive::Bus::Counts;
    return Fields<C>()
        .add("requests", &C::sent, "Sent, repetitions too")
        .add("answers", &C::done, "That were taken")
        .add("timeouts", &C::timeouts, "Requests without an answer")
        .add("crc_errors", &C::crcErrors, "Damaged answers")
        .add("unexpected", &C::unexpected, "Answers to something else");
}

} // namespace hermes

namespace hermes::motorcontrol {

bool allStand(const Telemetry &t) {
    return std::all_of(t.controllers.begin(), t.controllers.end(), [](const auto &c) { return c.stands; });
}

QString turningOf(const Telemetry &t) {
    QStringList names;
    for (const Telemetry::Controller &c : t.controllers)
        if (c.ready ? !c.stands : c.mayTurn)
            names.append(c.name);
    return names.isEmpty() ? QString() : "wheels of " + names.join(" and ") + " turn, or were not read since";
}

OdometryMessage odometryOf(const Telemetry &t) {
    return {t.pose, t.twist, t.covariance, t.mono};
}

WheelsMessage wheelsOf(const Telemetry &t, const WheelLayout &layout) {
    WheelsMessage message;
    for (std::size_t i = 0; i < wheelCount; ++i) {
        if (layout.has(int(i)))
            message.*WheelsMessage::wheels()[i] =
                WheelMessage{t.target[i], t.setPoint[i], t.speeds[i], t.turns[i]};
    }
    message.slip = t.slip;
    message.target = layout.twist(t.target, t.targetSteering);
    if (layout.steers())
        message.steering = t.steering;
    return message;
}

PowerMessage powerOf(const Telemetry &t, const BatteryState &battery) {
    PowerMessage message;
    message.battery = battery;
    for (const Telemetry::Controller &controller : t.controllers) {
        const drive::Readings &r = controller.readings;
        QStringList meanings;
        for (quint32 bit = 1; bit != 0; bit <<= 1) {
            if (r.status & bit)
                meanings.append(roboclaw::statusText(bit));
        }
        for (const char *fault : r.faults)
            if (fault)
                meanings.append(fault);
        message.controllers.push_back({controller.ready && r.complete, r.battery_v, r.logic_v, r.current_a,
                                       r.temperature_c, r.status, meanings, r.duty});
    }
    return message;
}

Result<BatteryReading> batteryOf(const Telemetry &t) {
    BatteryReading reading;
    for (const Telemetry::Controller &controller : t.controllers) {
        const drive::Readings &r = controller.readings;
        if (!controller.ready || !r.complete) // what its motors draw is not known
            return Error(ErrorCode::NotReady, "no controller tells voltage and current");
        if (!r.duty)
            return Error(ErrorCode::DeviceFault, controller.name + " does not tell the duties of its motors");
        reading.voltages.push_back(r.battery_v);
        for (std::size_t motor = 0; motor < 2; ++motor) // a bridge takes what its duty lets through
            reading.motors_a += std::abs(r.current_a[motor] * (*r.duty)[motor]);
    }
    return reading;
}

MotionHold holdOf(const Telemetry &t) {
    return {t.latch.causes(), t.lease.state(monotonicNow()), t.haltReason, t.haltCause};
}

CycleState cycleOf(const Telemetry &t) {
    return {std::chrono::duration<double>(DriveLoop::period).count(), t.cycle, t.unread, t.realtime};
}

Standing standingOf(const Telemetry &t) {
    Standing standing;
    QStringList texts;
    for (const Telemetry::Controller &c : t.controllers) {
        standing.controllers.push_back({c.name, c.stands, {}});
        if (c.stands)
            continue;
        QString &reason = standing.controllers.back().reason;
        reason =
            c.error.isEmpty()
                ? QString("its wheels turn, or it was not read since: its line may be silent for another one")
                : c.error;
        texts.append(c.name + " is not confirmed to stand: " + reason);
    }
    standing.all.confirmed = allStand(t);
    standing.all.text = texts.join("; ");
    return standing;
}

Fields<Standing::Controller> fieldsOf(Of<Standing::Controller>) {
    using C = Standing::Controller;
    return Fields<C>()
        .add("name", &C::name, "Address and line")
        .add("confirmed", &C::confirmed, "It stands")
        .add("reason", &C::reason, "Why that is not confirmed, or empty");
}

Fields<Standing> fieldsOf(Of<Standing>) {
    return Fields<Standing>().include(&Standing::all).add("controllers", &Standing::controllers, "Each");
}

Fields<CycleStatistics> fieldsOf(Of<CycleStatistics>) {
    return Fields<CycleStatistics>()
        .add("cycles", &CycleStatistics::cycles, "Since the start")
        .add("missed", &CycleStatistics::missed, "Periods without a cycle: it came too late")
        .add("mean_lateness_s", &CycleStatistics::meanLateness_s, "Of the last 50 cycles", "s")
        .add("worst_lateness_s", &CycleStatistics::worstLateness_s, "Of the last 50 cycles", "s");
}

Fields<CycleState> fieldsOf(Of<CycleState>) {
    using C = CycleState;
    return Fields<C>()
        .add("period_s", &C::period_s, "Of the cycle", "s")
        .include(&C::statistics)
        .add("unread", &C::unread, "Reports that were taken too slowly")
        .add("realtime", &C::realtime, "It goes before all ordinary threads");
}

Fields<Telemetry::Controller> fieldsOf(Of<Telemetry::Controller>) {
    using C = Telemetry::Controller;
    return Fields<C>()
        .add("name", &C::name, "Address and line")
        .add("ready", &C::ready, "It can be driven")
        .add("confirmed", &C::stands, "It has confirmed that it stands")
        .add("error", &C::error, "Why it is not ready, or empty")
        .add("version", &C::version, "Of its firmware")
        .include(&C::counts)
        .add("stray_bytes", &C::strayBytes, "On its line, when none was awaited")
        .add("timeout_s", &C::timeout_s,
             "Without a command for so long it stops by itself; missing: it never does", "s")
        .add("coasts", &C::coasts, "Then its wheels roll, they do not brake")
        .add("rate_hz", &C::rate_Hz, "Of readings that its line gives; 0: not known", "Hz")
        .add("overruns", &C::overruns, "Cycles that began before the encoders of the last were read");
}

Fields<MotorState> fieldsOf(Of<MotorState>) {
    using S = MotorState;
    return Fields<S>()
        .add("ready", &S::ready, "All controllers are")
        .add("standing", &S::standing, "As motor.stop answers")
        .add("estop", &S::estop, "The emergency stop is latched")
        .include(&S::hold)
        .add("pose", &S::pose, "As in the topic odometry")
        .add("twist", &S::twist, "As measured")
        .add("target", &S::target, "The velocity that was commanded")
        .add("set_point", &S::setPoint, "The velocity on the way there")
        .add("wheels", &S::wheels, "As in the topic wheels")
        .add("counter_jumps", &S::counterJumps, "Times that a controller lost its counts")
        .add("longest_way_m", &S::longestWay_m,
             "From motion.vx, when this program dies: until the controllers stop by themselves, and braking; "
             "where one coasts, at least. Missing: one never stops",
             "m")
        .add("moves_sideways", &S::movesSideways, "Its wheels can")
        .add("least_radius_m", &S::leastRadius_m, "Of the tightest bend; 0: it turns on the spot", "m")
        .add("controllers", &S::controllers, "Each, with its traffic")
        .add("cycle", &S::cycle, "How punctual it is")
        .add("battery", &S::battery, "How full it is, and how long it lasts");
}

} // namespace hermes::motorcontrol
