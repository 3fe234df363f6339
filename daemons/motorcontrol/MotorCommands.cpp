#include "common/Time.h"
#include "daemons/motorcontrol/MotorControl.h"
#include "protocol/wire/Fields.h"

#include <algorithm>

namespace hermes::motorcontrol {
namespace {

Field stampField() {
    return Field::number("stamp", "When the command was made, seconds since the epoch; one older than "
                                  "safety.command_timeout_s is refused")
        .unit("s")
        .optional();
}

/// How old it may be: by its stamp, and by how long it may have waited to be read.
double ageOf(const Call &call) {
    const double waited = bootNow() - call.earliest;
    const double age = call.has("stamp") ? stampNow() - call.number("stamp") : waited;
    return age < 0 ? age : std::max(age, waited);
}

Field clientField() {
    return Field::text("client", "Name of the client, for others").with("maxLength", 100).byDefault("");
}

QString clientName(const Call &call) {
    return call.text("client").isEmpty() ? call.clientName : call.text("client");
}

/// Who stops or releases: as it calls itself, and where it is connected, which it cannot choose.
QString callerName(const Call &call) {
    return call.text("client").isEmpty() ? call.clientName : call.text("client") + ", " + call.clientName;
}

Result<QJsonValue> nullOr(const Result<void> &result) {
    if (!result)
        return result.error();
    return QJsonValue();
}

} // namespace

hermes::Command
MotorControl::loopCommand(const QString &name, const QString &summary,
                          const std::function<Result<QJsonValue>(const Call &, DriveLoop &)> &work) {
    return hermes::Command(name, summary)
        .returnsNull()
        .asyncHandler([this, work](const Call &call, const Reply &reply) {
            inLoop([call, work](DriveLoop &loop) { return work(call, loop); }, reply);
        });
}

hermes::Command MotorControl::stopCommand(const QString &name, const QString &summary,
                                          const std::function<void(const Call &, Drive &)> &stop) {
    return hermes::Command(
               name, summary + ". Tells which controllers have confirmed that they stand: a set-point of "
                               "zero acknowledged, and since then no motion of the encoders")
        .param(Field::number("wait_s",
                             "Answers when all have confirmed, after this time at the latest; 0: at once")
                   .unit("s")
                   .range(0, 10)
                   .byDefault(0))
        .param(clientField())
        .gives<Standing>()
        .needs(Role::Observer)
        .urgent()
        .asyncHandler([this, stop](const Call &call, const Reply &reply) {
            const double until = monotonicNow() + call.number("wait_s");
            const auto standing = std::make_shared<Standing>();
            inLoop(
                [call, stop, standing](DriveLoop &loop) -> Result<QJsonValue> {
                    stop(call, loop.drive());
                    loop.makeVoid(call); // it may have overtaken what came before it
                    *standing = standingOf(loop.telemetry());
                    return QJsonValue();
                },
                Reply([this, reply, until, standing](const Result<QJsonValue> &result) {
                    if (!result)
                        return reply.give(result);
                    if (monotonicNow() >= until || standing->all.confirmed)
                        return reply.result(asJson(*standing));
                    stops_.push_back({reply, until});
                }));
        });
}

hermes::Command
MotorControl::freshLoopCommand(const QString &name, const QString &summary,
                               const std::function<Result<QJsonValue>(const Call &, DriveLoop &)> &work) {
    const auto unlessVoid = [work](const Call &call, DriveLoop &loop) -> Result<QJsonValue> {
        if (loop.isVoid(call))
            return Error(ErrorCode::NotReady,
                         "this came before a stop, or before the drive loop stood still: it is void");
        return work(call, loop);
    };
    return loopCommand(name, summary, unlessVoid).fresh();
}

void MotorControl::declareMotorCommands() {
    addCommand(freshLoopCommand(
                   "motor.drive",
                   "Drives with this velocity, in the robot's frame, until the next command; to be sent at "
                   "10 Hz or more. Wheels that would be too fast slow all down alike",
                   [](const Call &call, DriveLoop &loop) {
                       const Twist2D twist{call.number("vx"), call.number("vy"), call.number("omega")};
                       return nullOr(
                           loop.drive().driveTwist(call.client, twist, ageOf(call), monotonicNow()));
                   })
                   .param(Field::number("vx", "Forward").unit("m/s").byDefault(0))
                   .param(Field::number("vy", "To the left").unit("m/s").byDefault(0))
                   .param(Field::number("omega", "Counter-clockwise").unit("rad/s").byDefault(0))
                   .param(stampField())
                   .with("x-needs-lease", true)
                   .example({{"vx", 0.3}, {"vy", 0}, {"omega", 0.1}}, QJsonValue()));
    hermes::Command wheels = freshLoopCommand(
        "motor.wheels",
        "Turns each wheel with its own speed, until the next command: for tests with the "
        "robot jacked up",
        [](const Call &call, DriveLoop &loop) {
            WheelValues speeds{};
            for (int i = 0; i < wheelCount; ++i)
                speeds[i] = call.number(wheelNames[i]);
            return nullOr(loop.drive().driveWheels(call.client, speeds, ageOf(call), monotonicNow()));
        });
    for (const char *name : wheelNames)
        wheels.param(
            Field::number(name, "Positive turns drive the robot forward; of omni wheels counter-clockwise")
                .unit("rad/s")
                .byDefault(0));
    addCommand(
        wheels.param(stampField()).with("x-needs-lease", true).example({{"front_left", 1}}, QJsonValue()));
    addCommand(
        stopCommand("motor.stop",
                    "Stops with the emergency deceleration; anyone may. When another client holds the "
                    "control it loses it",
                    [](const Call &call, Drive &drive) { drive.stop(call.client, callerName(call)); }));
    addCommand(
        stopCommand("motor.estop",
                    "Stops with the emergency deceleration, and stays stopped until motor.reset_estop; "
                    "anyone may. No substitute for a hard-wired device",
                    [](const Call &call, Drive &drive) {
                        drive.emergencyStop(call.client, callerName(call), monotonicNow());
                    }));
    addCommand(freshLoopCommand(
                   "motor.reset_estop",
                   "Releases the emergency stop and latched faults, once the wheels stand; the robot stays "
                   "where it is until a client acquires the control and drives. An emergency stop is "
                   "released 2 s after the last press at the earliest, by the client that alone pressed it, "
                   "or when a person confirms; never by one that was driving when another pressed it",
                   [](const Call &call, DriveLoop &loop) -> Result<QJsonValue> {
                       const auto may =
                           loop.drive().mayReset(call.client, call.flag("confirm"), monotonicNow());
                       if (!may)
                           return may.error();
                       if (const QString turning = turningOf(loop.telemetry());
                           loop.drive().latch().isSet() && !turning.isEmpty())
                           return Error(ErrorCode::NotReady,
                                        turning + ", expected wheels that stand before it is released");
                       loop.drive().resetEmergencyStop(callerName(call));
                       return QJsonValue();
                   })
                   .param(Field::boolean("confirm", "A person has looked at the robot, and lets it move "
                                                    "again")
                              .byDefault(false))
                   .param(clientField()));
    addCommand(
        hermes::Command("motor.state",
                        "Everything: stops, control, pose, speeds, controllers, punctuality of the cycle")
            .needs(Role::Observer)
            .answers([this](const Call &) { return state(); }));
    addCommand(
        loopCommand("odometry.reset", "Sets the pose, as certain",
                    [](const Call &call, DriveLoop &loop) -> Result<QJsonValue> {
                        loop.odometry().reset({call.number("x"), call.number("y"), call.number("theta")});
                        return QJsonValue();
                    })
            .param(Field::number("x", "Position").unit("m").range(-1e6, 1e6).byDefault(0))
            .param(Field::number("y", "Position").unit("m").range(-1e6, 1e6).byDefault(0))
            .param(Field::number("theta", "Heading").unit("rad").range(-1e3, 1e3).byDefault(0)));
}

void MotorControl::declareControlCommands() {
    addCommand(
        freshLoopCommand(
            "control.acquire",
            "Gives this client the control: only it may move the robot, as long as it sends motion "
            "commands at least every timeout_s and stays connected",
            [](const Call &call, DriveLoop &loop) -> Result<QJsonValue> {
                const QString name = clientName(call);
                const double now = monotonicNow();
                const double timeout_s = call.number("timeout_s");
                const auto acquired =
                    call.flag("take_over")
                        ? loop.drive().takeOver(call.client, name, timeout_s, now, ageOf(call))
                        : loop.drive().acquire(call.client, name, timeout_s, now, ageOf(call));
                if (!acquired)
                    return acquired.error();
                return asJson(loop.drive().lease().state(now));
            })
            .param(clientField())
            .param(Field::number("timeout_s", "Without a motion command for so long the control ends")
                       .unit("s")
                       .range(0.1, 60)
                       .byDefault(1))
            .param(Field::boolean("take_over", "Take it from another client that holds it: the robot stops, "
                                               "and the other one is refused from then on")
                       .with("x-role", toString(Role::Engineer))
                       .byDefault(false))
            .gives<LeaseState>()
            .example({{"client", "joystick"}, {"timeout_s", 1}},
                     QJsonObject{{"held", true}, {"holder", "joystick"}, {"remaining_s", 1}}));
    addCommand(loopCommand("control.release", "Gives the control back; the robot stops",
                           [](const Call &call, DriveLoop &loop) -> Result<QJsonValue> {
                               loop.drive().release(call.client);
                               return QJsonValue();
                           }));
    addCommand(loopCommand("control.ask",
                           "Asks who holds the control to give it back: its state names this client as the "
                           "one who wants it, until it changes hands",
                           [](const Call &call, DriveLoop &loop) -> Result<QJsonValue> {
                               loop.drive().ask(call.client, clientName(call));
                               return asJson(loop.drive().lease().state(monotonicNow()));
                           })
                   .param(clientField())
                   .gives<LeaseState>());
    addCommand(
        hermes::Command("control.state", "Who holds the control, and for how long without a further command")
            .needs(Role::Observer)
            .answers([this](const Call &) { return told_.lease.state(monotonicNow()); }));
}

} // namespace hermes::motorcontrol
