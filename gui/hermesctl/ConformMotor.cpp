// hermesctl conform motor: what the clients of a motor control rely on, tried with any daemon.
#include "common/client/DaemonAddress.h"
#include "common/interface/InterfaceRegistry.h"
#include "common/settings/DottedPath.h"
#include "gui/hermesctl/Conformance.h"
#include "gui/hermesctl/Descriptions.h"
#include "gui/hermesctl/Driver.h"
#include "protocol/messages/Motors.h"

#include <QJsonArray>
#include <algorithm>
#include <cmath>

namespace hermes::ctl {
namespace {

/// Its parts follow each other; before and after each the wheels stand, and nobody has the control.
class MotorTest : Conformance {
public:
    MotorTest(Client &client, const Arguments &arguments)
        : Conformance(arguments)
        , mine_(client)
        , odometry_(client, "odometry") {}

    Result<void> run() {
        for (Client *const other : {&other_, &third_})
            if (const auto done = connectTo(*other, arguments_.words[0]); !done)
                return done;
        describe();
        if (const auto isFree = readState(); !isFree)
            return isFree;
        pass(2);
        if (comes("odometry", odometry_, 10)) {
            watchOdometry();
            for (const auto part :
                 {&MotorTest::control, &MotorTest::refusals, &MotorTest::noNumbers, &MotorTest::motions,
                  &MotorTest::silence, &MotorTest::takeOver, &MotorTest::stops, &MotorTest::emergency}) {
                if (!isEnded())
                    (this->*part)();
                (void)stop(mine_); // also when a signal has ended it
                for (Client *const client : {&mine_, &other_})
                    (void)call(*client, "control.release");
            }
        }
        return result();
    }

private:
    using Codes = std::vector<ErrorCode>;
    const Codes held{ErrorCode::ControlHeld}, notReady{ErrorCode::NotReady},
        stopped{ErrorCode::NotReady, held[0]};
    static constexpr Twist2D ahead{0.1, 0, 0};

    Result<QJsonValue> stop(Client &client, const QString &method = "motor.stop") {
        return client.callAndWait(method, QJsonObject{{"wait_s", 5}},
                                  arguments_.timeout + std::chrono::seconds(5), Client::Repeats::AtOnce);
    }
    Result<QJsonValue> acquire(Client &client, double timeout_s = 20, bool takesOver = false) {
        QJsonObject params{{"client", &client == &mine_ ? "conform" : "other"}, {"timeout_s", timeout_s}};
        if (takesOver)
            params.insert("take_over", true);
        return call(client, "control.acquire", params);
    }
    Result<QJsonValue> driveOnce(Client &client, QJsonObject params = {{"vx", ahead.vx}}) {
        return call(client, "motor.drive", params);
    }
    /// Takes the control and drives; gives when the last command had been sent.
    double begin() {
        accepted("control.acquire", acquire(mine_));
        const auto driven = driveFor(mine_, ahead, 0.6);
        must("motor.drive for 0.6 s", bool(driven), "accepted", driven ? "accepted" : driven.error().message);
        return monotonicNow();
    }
    void stands(const QString &after, double since, double silent_s = 0) {
        constexpr double late_s = 0.15; // how late this program may see it
        const double most = silent_s + ahead.vx / deceleration_ + late_s;
        const double measured = standsAfter(odometry_, since, most + 1.5);
        must("the wheels stand after " + after, measured <= most,
             QString("at most %1 s").arg(most, 0, 'f', 2),
             QString(measured > most + 1.4 ? "still turning after %1 s" : "%1 s").arg(measured, 0, 'f', 3));
    }

    void describe() {
        const auto description = call(mine_, "rpc.discover"), settings = call(mine_, "settings.get");
        for (const QString wanted :
             {"control.acquire client:string timeout_s:number take_over:boolean", "control.release",
              "motor.drive vx:number vy:number omega:number stamp:number", "motor.state",
              "motor.stop wait_s:number client:string", "motor.estop wait_s:number client:string",
              "motor.reset_estop confirm:boolean client:string"}) {
            const QStringList words = wanted.split(' ');
            const QJsonObject method =
                named(description ? (*description)["methods"].toArray() : QJsonArray(), words[0]);
            QStringList found{method["name"].toString("no such command")};
            for (const QJsonValue &one : method["params"].toArray())
                found.append(one["name"].toString() + ':' + one["schema"]["type"].toString() +
                             (one["required"].toBool() ? " required" : ""));
            bool holds = found.filter(" required").isEmpty();
            for (const QString &word : words)
                holds = holds && found.contains(word);
            must("describes " + words[0], holds, wanted + ", none required", found.join(' '));
        }
        const std::pair<const char *, double *> numbers[]{{"motion.vx", &most_.vx},
                                                          {"motion.omega", &most_.omega},
                                                          {"safety.command_timeout_s", &commandTimeout_s_},
                                                          {"safety.deceleration", &deceleration_}};
        for (const auto &[path, value] : numbers) {
            const double found = settings ? valueAt(settings->toObject(), path).toDouble() : 0;
            must(QString("declares ") + path, found > 0, "a setting above 0", QString::number(found));
            *value = found > 0 ? found : *value;
        }
    }

    /// Error: somebody drives, or it is stopped already.
    Result<void> readState() {
        if (const auto ready = waitUntilReady(mine_, arguments_); !ready)
            return ready;
        const QJsonValue state = accepted("motor.state", call(mine_, "motor.state"));
        ReadReport report;
        const auto hold = readMessage<MotionHold>(WireValue(state), report);
        (void)readMessage<Pose2D>(WireValue(state["pose"]), report);
        must("motor.state's members",
             !report.hasFailed() && state["estop"].isBool() && state["ready"].toBool() &&
                 state["standing"]["confirmed"].isBool(),
             "pose, control, latched, estop, standing.confirmed, ready: true",
             report.hasFailed() ? report.text() : QString());
        if (const double radius = state["least_radius_m"].toDouble(); radius > 0) // it steers
            left_ = {ahead.vx, 0, std::min(left_.omega, ahead.vx / radius)};
        if (hold && (hold->control.held || !hold->latched.isEmpty()))
            return Error(ErrorCode::NotReady,
                         "the robot is driven by somebody, or is stopped: see motor.state");
        return {};
    }

    void watchOdometry() {
        stamps(odometry_, 0.2);
        const auto &first = odometry_.all.front(), &last = odometry_.all.back();
        should("odometry's mono", first.data.mono != 0, "the stamp by a clock that never jumps");
        const double apart = std::abs(last.data.mono - first.data.mono - (last.stamp - first.stamp));
        must("stamps go on as mono does", first.data.mono == 0 || apart < 0.05, "the same",
             QString("%1 s apart in %2 s").arg(apart, 0, 'f', 3).arg(last.stamp - first.stamp, 0, 'f', 3));
    }

    void control() {
        refused("motor.drive without the control", driveOnce(mine_), held);
        const QJsonValue state = accepted("control.acquire", acquire(mine_));
        const bool tells = state["held"].toBool() && state["holder"] == "conform";
        must("control.acquire tells the holder", tells, "held: true, holder: conform");
        const auto second = acquire(other_);
        const bool isNamed = !second && second.error().data["holder"] == "conform";
        refused("control.acquire of a second client", second, held);
        should("that refusal names the holder", isNamed, "data.holder: conform");
        refused("motor.drive of a second client", driveOnce(other_), held);
        accepted("motor.drive of the holder", driveOnce(mine_));
        accepted("control.release", call(mine_, "control.release"));
        refused("motor.drive after control.release", driveOnce(mine_), held);
        accepted("control.acquire for 0.5 s", acquire(mine_, 0.5));
        pass(0.8);
        refused("motor.drive after these 0.5 s", driveOnce(mine_), held);
        accepted("control.acquire of a second client then", acquire(other_));
    }

    void refusals() {
        accepted("control.acquire", acquire(mine_));
        const Codes params{ErrorCode::InvalidParams}, limits{ErrorCode::OverLimit, ErrorCode::InvalidParams};
        refused("motor.drive with an unknown parameter", driveOnce(mine_, {{"speed", 0}}), params);
        refused("motor.drive with a text", driveOnce(mine_, {{"vx", "fast"}}), params);
        refused("motor.drive with null", driveOnce(mine_, {{"vx", QJsonValue()}}), params);
        refused("motor.drive above motion.vx", driveOnce(mine_, {{"vx", 1.01 * most_.vx}}), limits);
        refused("motor.drive below -motion.vx", driveOnce(mine_, {{"vx", -1.01 * most_.vx}}), limits);
        refused("motor.drive above motion.omega", driveOnce(mine_, {{"omega", 1.01 * most_.omega}}), limits);
        accepted("motor.drive with the stamp of now", driveOnce(mine_, {{"stamp", stampNow()}}));
        refused("motor.drive with an old stamp", driveOnce(mine_, {{"stamp", stampNow() - 10}}), notReady);
        refused("motor.drive with a future stamp", driveOnce(mine_, {{"stamp", stampNow() + 10}}), notReady);
    }

    /// What is no JSON goes as it is over a connection of its own.
    void noNumbers() {
        const auto url = InterfaceUrl::parse(asOwner(*daemonAddress(arguments_.words[0], arguments_.host)));
        const auto made = makeInterface(*url, nullptr);
        if (!made || url->protocol() != "json")
            return should("motor.drive with NaN", false, "an address with the framing json");
        const std::unique_ptr<Interface> line(*made);
        QByteArray answers;
        const QByteArray asked =
            R"({"jsonrpc":"2.0","id":1,"method":"control.acquire","params":{"timeout_s":20}}
{"jsonrpc":"2.0","id":2,"method":"motor.drive","params":{"vx":NaN}}
{"jsonrpc":"2.0","id":3,"method":"motor.drive","params":{"vx":1e999}}
)";
        QObject::connect(line.get(), &Interface::received, [&](const QByteArray &more) { answers += more; });
        QObject::connect(line.get(), &Interface::opened, [&] { line->write(asked); });
        line->open();
        pass(0.5);
        line->close();
        must("motor.drive with NaN and 1e999 is refused",
             answers.count("\"result\"") < 2 && answers.count("\"error\"") >= 2, "two errors",
             QString("%1 errors").arg(answers.count("\"error\"")));
        pass(0.3);
        should("a client that has gone loses the control", bool(acquire(other_)), "at once");
        comes("odometry after refusals", odometry_, 10);
    }

    void motions() {
        accepted("control.acquire", acquire(mine_));
        moves("ahead", ahead);
        moves("to the left", left_);
        moves("ahead after the turn", ahead);
    }
    /// Signs and frames: where the odometry leads, in the frame of the pose before.
    void moves(const QString &way, const Twist2D &velocity) {
        const Pose2D from = odometry_.all.back().data.pose;
        const double begun = monotonicNow();
        const auto driven = driveFor(mine_, velocity, 1);
        if (!driven)
            return must("motor.drive " + way, false, "accepted", driven.error().message);
        const Twist2D twist = odometry_.all.back().data.twist;
        const double ended = monotonicNow();
        const auto standing = stop(mine_);
        must("motor.stop " + way, standing && (*standing)["confirmed"].toBool(),
             "confirmed: true within wait_s");
        stands("motor.stop " + way, ended);
        const Pose2D moved = from.inverse() * odometry_.all.back().data.pose;
        const Pose2D ideal = velocity.motion(ended - begun);
        near("odometry " + way, {moved.x, moved.y, moved.theta}, {ideal.x, ideal.y, ideal.theta});
        near("twist " + way, {twist.vx, twist.vy, twist.omega}, {velocity.vx, velocity.vy, velocity.omega});
    }
    /// The robot has to brake, and may be slow to start.
    void near(const QString &what, const std::array<double, 3> &found, const std::array<double, 3> &wanted) {
        bool holds = true;
        QStringList texts[2];
        for (std::size_t i = 0; i < 3; ++i) {
            holds = holds && (wanted[i] == 0 ? std::abs(found[i]) < 0.03
                                             : found[i] > 0.5 * wanted[i] && found[i] < 1.4 * wanted[i]);
            texts[0].append(QString::number(found[i], 'f', 3));
            texts[1].append(QString::number(wanted[i], 'f', 3));
        }
        must(what, holds, texts[1].join(", ") + " or so, ahead, to the left and counter-clockwise",
             texts[0].join(", "));
    }

    void silence() {
        should("safety.command_timeout_s is short", commandTimeout_s_ <= 1, "1 s at most");
        stands("the last command of a silent client", begin(), commandTimeout_s_);
    }

    void takeOver() {
        const double taken = begin();
        const auto answer = acquire(other_, 20, true);
        if (!answer && answer.error().is(ErrorCode::NotAuthorised))
            return should("take-over", false, "the rights of an engineer", answer.error().message);
        accepted("take-over", answer);
        refused("motor.drive after a take-over", driveOnce(mine_), held);
        stands("a take-over", taken);
    }

    void stops() {
        const double asked = begin();
        accepted("motor.stop of another client", stop(other_));
        stands("motor.stop of another client", asked);
        refused("motor.drive after that stop", driveOnce(mine_), held);
    }

    void emergency() {
        const double pressed = begin();
        const QJsonValue standing = accepted("motor.estop of another client", stop(other_, "motor.estop"));
        must("motor.estop", standing["confirmed"].toBool(), "confirmed: true within wait_s");
        stands("motor.estop", pressed);
        const QJsonValue state = accepted("motor.state", call(mine_, "motor.state"));
        must("it is latched", state["estop"].toBool() && state["latched"]["estop"].isString(),
             "estop, latched.estop");
        refused("motor.drive after motor.estop", driveOnce(mine_), stopped);
        (void)acquire(other_);
        refused("motor.drive of another client after it", driveOnce(other_), stopped);
        const QJsonObject confirmed{{"confirm", true}};
        (void)call(other_, "motor.estop"); // once more: what came before may have taken long
        refused("motor.reset_estop at once", call(third_, "motor.reset_estop", confirmed), notReady);
        pass(2.2);
        refused("motor.reset_estop without confirm", call(third_, "motor.reset_estop"), notReady);
        refused("motor.reset_estop of who drove", call(mine_, "motor.reset_estop", confirmed), notReady);
        refused("motor.drive after refused resets", driveOnce(other_), stopped);
        accepted("motor.reset_estop with confirm", call(third_, "motor.reset_estop", confirmed));
        refused("motor.drive after the reset", driveOnce(mine_), held);
    }

    Client &mine_;
    Client other_, third_;
    OdometryRecord odometry_;
    Twist2D most_{1, 0, 1}, left_{0, 0, 0.3};
    double commandTimeout_s_ = 0.25, deceleration_ = 0.4;
};

} // namespace

Result<void> conformMotor(Client &client, const Arguments &arguments) {
    const auto confirmed = confirmFreeWheels(arguments);
    return confirmed ? MotorTest(client, arguments).run() : confirmed;
}

} // namespace hermes::ctl
