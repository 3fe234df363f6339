#include "Trial.h"

#include "StandJudge.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace campaign {

using namespace hermes;
using namespace hermes::motorcontrol;
using namespace hermes::simulator;

namespace {

constexpr double start = 1; // on the clock of the robot
constexpr double commandPeriod = 0.05;
constexpr double recovery = 8;  // once all is mended, the robot drives within
constexpr double readiness = 3; // undisturbed, it drives within
constexpr double slow = 0.05;   // m/s: slower it does not drive
constexpr quint64 bystander = 1077, rival = 1099;

/// Settings with their defaults where the case says nothing, and more.
MotorSettings settingsOf(const Case &c, const QJsonObject &more = {}) {
    Settings settings;
    declareMotorSettings(settings);
    settings.addRule(checkMotorSettings);
    QJsonObject all = c.settings;
    QJsonObject controllers = all["controllers"].toObject();
    if (c.twoLines)
        controllers["2"] = QJsonObject{{"url", "serial:///dev/ttyACM1?baud=115200"}};
    all["controllers"] = controllers;
    for (auto group = more.begin(); group != more.end(); ++group) {
        QJsonObject values = all[group.key()].toObject();
        const QJsonObject changed = group.value().toObject();
        for (auto entry = changed.begin(); entry != changed.end(); ++entry)
            values[entry.key()] = entry.value();
        all[group.key()] = values;
    }
    const auto set = settings.set(all);
    if (!set)
        throw std::runtime_error("seed " + std::to_string(c.seed) + ": " + set.error().message.toStdString());
    return MotorSettings::from(settings);
}

Drivetrain::Options drivetrainOf(const Case &c, const MotorSettings &settings) {
    Drivetrain::Options options;
    const bool mecanum = c.settings["frame"].toObject()["layout"].toString() != "differential";
    options.base.kind = mecanum ? WheelBase::Kind::Mecanum : WheelBase::Kind::Differential;
    options.kind = c.kind;
    options.ownLines = c.twoLines;
    for (std::size_t i = 0; i < options.controller.size(); ++i) {
        options.controller[i].setFirmware(c.firmware);
        options.controller[i].seed = c.seed * 2 + i;
    }
    options.arduino.seed = options.vesc.seed = options.openCr.seed = options.roboteq.seed = c.seed;
    options.vesc.timeout = settings.serialTimeout_s; // as a person has set it
    options.vesc.brakeCurrent = 20;
    options.openCr.wheelRadius = options.base.radius;
    options.openCr.halfTrack = options.base.halfTrack;
    options.openCr.motor.fullSpeed *= settings.countsPerTurn / options.countsPerTurn;
    options.roboteq.motor.fullSpeed = settings.pid.qpps; // its full scale is that of its owner
    options.countsPerTurn = settings.countsPerTurn;
    return options;
}

int wheelNumber(const std::string &device) {
    const std::string names[] = {"front_left", "front_right", "rear_left", "rear_right"};
    for (int i = 0; i < 4; ++i) {
        if (names[i] == device)
            return i;
    }
    return -1;
}

class Trial {
public:
    explicit Trial(const Case &c)
        : case_(c)
        , settings_(settingsOf(c))
        , robot_(settings_, drivetrainOf(c, settings_))
        , judge_(robot_, start) {
        judge_.configure(settings_.emergencyDeceleration, settings_.drive.commandTimeout_s,
                         settings_.encoder.hold_s);
        if (c.movesAtFirst) {
            for (int i = 0; i < 4; ++i)
                robot_.robot.wheel(i).driveSpeed(20000);
            for (int i = 0; i < 300; ++i)
                robot_.robot.advance(0.001);
            judge_.beginUnjustified("somebody else has set the wheels going");
        }
    }

    Outcome run() {
        plan();
        while (!events_.empty() && judge_.failure().empty()) {
            const auto event = events_.begin();
            goTo(event->first);
            const std::function<void()> happens = event->second;
            events_.erase(event);
            happens();
        }
        goTo(case_.duration);
        if (judge_.failure().empty())
            recover();
        Outcome outcome{judge_.failure().empty() ? failure_ : judge_.failure(), judge_.beyond(),
                        judge_.slowest(), stops_};
        return outcome;
    }

private:
    double time() const { return robot_.now() - start; }

    void plan() {
        for (const Fault &fault : case_.faults) {
            events_.emplace(fault.begin, [this, fault] { begin(fault); });
            events_.emplace(fault.end, [this, fault] { end(fault); });
        }
        for (const Step &step : case_.steps)
            events_.emplace(step.time, [this, step] { act(step); });
    }

    // The client's commands on the way, too.
    void goTo(double until) {
        while (robot_.now() < start + until && judge_.failure().empty()) {
            robot_.run(start + std::min(until, nextCommand_), [this] { watch(); });
            if (robot_.now() >= start + nextCommand_) {
                if (time() >= silentUntil_)
                    command(time());
                if (time() < foughtUntil_)
                    fight();
                nextCommand_ += commandPeriod;
            }
        }
    }
    void watch() {
        const bool before = judge_.isJustified();
        judge_.watch();
        stops_ += before && !judge_.isJustified();
        if (!case_.isUndisturbed())
            return;
        drove_ = judge_.fastest() > slow ? time() : std::max(drove_, readiness);
        if (time() > drove_ + 0.1 && failure_.empty())
            failure_ = "it does not drive though nothing is wrong: " + reason();
    }
    std::string reason() {
        QString reason = robot_.engine->drive().haltReason();
        for (int i = 0; i < robot_.robot.controllers(); ++i)
            reason += "; " + robot_.engine->controller(i).error();
        return reason.toStdString();
    }

    /// One command of the client, made then.
    void command(double made) {
        Drive &drive = robot_.engine->drive();
        const double now = robot_.now();
        if (!drive.lease().isHeldBy(client_)) {
            if (recovers_) // a person
                release();
            else if (case_.resets && drive.mayReset(client_, false, now))
                drive.resetEmergencyStop();
            if (!drive.acquire(client_, "driver", case_.lease_s, now))
                return robot_.obey();
            judge_.endJustification("the control was acquired anew");
        }
        const double share = case_.steered(made);
        const Twist2D twist{case_.vx * share, case_.vy * share, case_.omega * share};
        const double age = case_.stamps ? time() - made : 0;
        if (drive.driveTwist(client_, twist, age, now))
            accept(case_.stamps ? made : time()); // without a stamp it is good from when it comes
        robot_.obey();
    }
    void accept(double made) {
        if (isHeld_ && failure_.empty())
            failure_ = "a command was accepted though nobody who may has released the emergency stop";
        judge_.justify(made);
    }
    void release() {
        robot_.engine->drive().resetEmergencyStop();
        isHeld_ = false;
    }
    /// Another client does all that it can to drive.
    void fight() {
        Drive &drive = robot_.engine->drive();
        const double now = robot_.now();
        if (drive.mayReset(rival, false, now))
            drive.resetEmergencyStop();
        if (drive.acquire(rival, "rival", case_.lease_s, now))
            judge_.endJustification("the rival acquired the control");
        if (drive.driveTwist(rival, {case_.vx, case_.vy, case_.omega}, 0, now))
            accept(time());
        robot_.obey();
    }
    void endProcess(double seconds) {
        const StopLatch latch = robot_.engine->drive().latch();
        judge_.endJustification("the motor control ended");
        judge_.setStalled(true);
        robot_.stall(robot_.now() + seconds, [this] { watch(); });
        judge_.setStalled(false);
        robot_.restart(settings_, latch.has(Drive::emergencyCause)
                                      ? std::optional(latch.reason(Drive::emergencyCause))
                                      : std::nullopt);
        judge_.restart();
        ++client_;
        nextCommand_ = time();
    }

    void act(const Step &step) {
        Drive &drive = robot_.engine->drive();
        const std::string &a = step.action;
        const auto ends = [&] { judge_.endJustification(a); };
        if (a == "falls silent") {
            silentUntil_ = step.time + step.amount;
        } else if (a == "stops") {
            drive.stop(client_, "driver");
            silentUntil_ = time() + step.amount;
            ends();
        } else if (a == "is stopped by another") {
            drive.stop(bystander, "bystander");
            ends();
        } else if (a == "emergency stop") {
            drive.emergencyStop(bystander, "bystander", robot_.now());
            isHeld_ = true;
            ends();
            events_.emplace(time() + Drive::holdOff_s + step.amount, [this] {
                if (robot_.engine->drive().mayReset(bystander, true, robot_.now()))
                    release();
            });
        } else if (a == "is fought by a rival") {
            foughtUntil_ = time() + 2 * step.amount;
        } else if (a == "the motor control is killed") {
            return endProcess(step.amount);
        } else if (a == "loses its connection") {
            if (drive.lease().isHeldBy(client_)) // else a rival drives on
                ends();
            drive.clientGone(client_);
            ++client_;
            silentUntil_ = step.amount > 1 ? time() + step.amount : 0;
        } else if (a == "gives the control back") {
            if (drive.lease().isHeldBy(client_))
                ends();
            drive.release(client_);
            silentUntil_ = time() + step.amount;
        } else if (a == "is taken over") {
            takeOver(step);
        } else if (a == "changes settings") {
            change(step);
            ends();
        } else {
            return stall(step.amount);
        }
        robot_.obey();
    }
    void takeOver(const Step &step) {
        ++client_;
        if (robot_.engine->drive().takeOver(client_, "another", case_.lease_s, robot_.now())) {
            judge_.endJustification("is taken over");
            silentUntil_ = time() + step.amount / 4;
        }
    }
    void change(const Step &step) {
        const double timeout = std::ceil(step.amount * 2.5) / 10; // 0.1 to 0.5 s
        const bool isFixed = case_.kind != "roboclaw" && case_.kind != "roboteq";
        robot_.engine->configure(
            settingsOf(case_, isFixed ? QJsonObject{{"pid", QJsonObject{{"p", 1 + timeout}}}}
                                      : QJsonObject{{"controllers", QJsonObject{{"timeout_s", timeout}}}}));
        judge_.reconfigure();
    }
    /// Whether the client sends nothing then, for what it does while the process stands still.
    bool isSilentAt(double when) const {
        return std::any_of(case_.steps.begin(), case_.steps.end(), [when](const Step &s) {
            return s.action == "falls silent" && s.time <= when && when < s.time + s.amount;
        });
    }
    // What the client sends meanwhile waits in the socket. After a gap of more than the command time-out it
    // is void, as the drive loop has it.
    void stall(double seconds) {
        judge_.setStalled(true);
        robot_.stall(robot_.now() + seconds, [this] { watch(); });
        judge_.setStalled(false);
        const bool isVoid = seconds > settings_.drive.commandTimeout_s;
        if (isVoid) {
            robot_.engine->drive().stoodStill("the drive loop stood still");
            judge_.endJustification("the process stood still");
            robot_.obey();
        }
        const double end = time();
        for (; nextCommand_ <= end; nextCommand_ += commandPeriod) {
            if (!isVoid && nextCommand_ >= silentUntil_ && !isSilentAt(nextCommand_))
                command(nextCommand_);
        }
    }

    void begin(const Fault &fault) {
        judge_.begin(fault);
        set(fault, true);
    }
    void end(const Fault &fault) {
        judge_.end(fault);
        set(fault, false);
    }
    void set(const Fault &fault, bool on) {
        const int second = fault.device.back() == '2';
        if (const int wheel = wheelNumber(fault.device); wheel >= 0)
            return setWheel(robot_.robot.wheel(wheel), fault, on);
        if (fault.device == "controllers")
            return robot_.robot.setSwapped(on);
        if (fault.device == "battery")
            return robot_.robot.battery().setCharge(on ? 0 : 1);
        if (fault.kind == "pulled")
            return robot_.setPulled(second, on);
        if (fault.kind == "adapter")
            return robot_.robot.setLatency(second, on ? fault.amount : 0);
        robot_.robot.controller(second).setFault(fault.kind, fault.amount, on);
    }
    static void setWheel(MotorChannel &motor, const Fault &fault, bool on) {
        if (fault.kind == "blocked")
            motor.setBlocked(on);
        else if (fault.kind == "encoder")
            motor.setEncoderBroken(on);
        else if (fault.kind == "backward")
            motor.setEncoderBackward(on);
        else if (on)
            motor.jump(std::int64_t(fault.amount));
    }
    // All is mended: the robot must not stay where it is for ever.
    void recover() {
        recovers_ = true;
        silentUntil_ = 0;
        robot_.robot.battery().setCharge(1);
        const double until = time() + recovery;
        while (time() < until && judge_.failure().empty()) {
            goTo(std::min(until, time() + 0.1));
            if (judge_.isJustified() && judge_.fastest() > slow)
                return;
        }
        if (failure_.empty())
            failure_ = "it does not drive again though all is mended: " + reason();
    }

    const Case &case_;
    MotorSettings settings_;
    VirtualRobot robot_;
    StandJudge judge_;
    std::multimap<double, std::function<void()>> events_;
    quint64 client_ = 1;
    double nextCommand_ = 0, silentUntil_ = 0, drove_ = 0, foughtUntil_ = 0;
    bool recovers_ = false, isHeld_ = false; ///< by an emergency stop that nobody who may has released
    int stops_ = 0;
    std::string failure_;
};

} // namespace

Outcome run(const Case &c) {
    return Trial(c).run();
}

} // namespace campaign
