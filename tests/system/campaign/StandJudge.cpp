#include "StandJudge.h"

#include <cmath>
#include <cstdarg>
#include <utility>

namespace campaign {

namespace {

constexpr double radius = 0.1;              // of a wheel
const char *const damage = "damaged bytes"; // on a wire without checksums
const char *const wheelNames[] = {"front_left", "front_right", "rear_left", "rear_right"};

std::string print(const char *format, ...) {
    char text[400];
    va_list values;
    va_start(values, format);
    std::vsnprintf(text, sizeof text, format, values);
    va_end(values);
    return text;
}

std::string controllerName(int number) {
    return "controller" + std::to_string(number + 1);
}

} // namespace

void StandJudge::configure(double deceleration, double commandTimeout_s, double hold_s) {
    deceleration_ = deceleration;
    commandTimeout_ = commandTimeout_s;
    hold_ = hold_s;
}

void StandJudge::begin(const Fault &fault) {
    const bool some = fault.kind == "loss" || fault.kind == "corrupt"; // of the answers
    if (fault.kind == "swapped")
        exchanged_ = time();
    if (!some || fault.amount >= 1)
        active_[{fault.device, fault.kind}] = time();
    if (fault.kind == "corrupt" && !robot_.kind.checksums)
        active_[{fault.device, damage}] = time();
}

void StandJudge::end(const Fault &fault) {
    const bool isDead =
        fault.kind == "brownout" || fault.kind == "restart"; // beyond the end of the case, too
    if (!isDead || time() >= fault.begin + fault.amount - 0.005)
        active_.erase({fault.device, fault.kind});
    if (fault.kind == "corrupt")
        active_.erase({fault.device, damage});
    ranAway_ = {}; // it is seen to follow again
    if (fault.kind == "swapped")
        exchanged_ = time();
    if (justified_ || (fault.kind != "deaf" && fault.kind != "pulled"))
        return;
    // What it hears then, be it for another one, lets its time-out begin anew.
    for (int controller = 0; controller < robot_.robot.controllers(); ++controller) {
        double &deadline = deadline_[std::size_t(controller)];
        deadline =
            std::max(deadline, time() + robot_.robot.controller(controller).timeout() + margin + braking());
    }
}

void StandJudge::setStalled(bool stalled) {
    if (stalled)
        stalledSince_ = time();
    else
        stalledSince_.reset(), resumed_ = time();
}

double StandJudge::rim(int wheel) const {
    return std::abs(robot_.robot.wheelSpeeds()[std::size_t(wheel)]) * radius;
}

double StandJudge::fastest() const {
    double most = 0;
    for (const double speed : robot_.robot.wheelSpeeds())
        most = std::max(most, std::abs(speed) * radius);
    return most;
}

void StandJudge::justify(double made) {
    if (const auto number = lostController(); number && !justified_)
        why_ = controllerName(*number) + " is not heard";
    if (time() >= made + commandTimeout_ || lostController())
        return;
    justified_ = true;
    until_ = made + commandTimeout_;
}

void StandJudge::endJustification(const std::string &why) {
    if (!justified_)
        return;
    beginUnjustified(why);
    ended_ = std::min(time(), until_);
    deadline_.fill(ended_ + reaction + braking());
}

void StandJudge::beginUnjustified(const std::string &why) {
    justified_ = false;
    why_ = why;
    ended_ = time();
    stalledFor_ = 0;
    speedAtEnd_ = fastest();
    excuse_ = "obeys";
    deadline_.fill(ended_ + reaction + braking());
}

std::optional<double> StandJudge::sinceOf(const std::string &device, const std::string &kind) const {
    const auto found = active_.find({device, kind});
    return found == active_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<double> StandJudge::unreachableSince(int controller) const {
    std::optional<double> since = stalledSince_;
    const auto take = [&](const std::optional<double> &other) {
        if (other && (!since || *other < *since))
            since = other;
    };
    take(sinceOf(controllerName(controller), "deaf"));
    take(sinceOf("line" + std::to_string(robot_.lineOf(controller) + 1), "pulled"));
    return since;
}

std::optional<double> StandJudge::disobedientSince(int controller) const {
    std::optional<double> since = sinceOf(controllerName(controller), "latched");
    const bool controlsStand = robot_.kind.name != std::string("arduino"); // else it takes the power away
    for (int wheel = 2 * controller; wheel < 2 * controller + 2 && controlsStand; ++wheel) {
        const auto backward = sinceOf(wheelNames[wheel], "backward");
        since = since ? since : backward;
    }
    if (!since && robot_.lines() > 1) // what is sent to it is for another address
        since = sinceOf("controllers", "swapped");
    return since ? std::max(*since, exchanged_) : since;
}

std::optional<double> StandJudge::unheardSince(int controller) const {
    std::optional<double> since = unreachableSince(controller);
    const auto take = [&](int number, const char *kind) {
        const auto other = sinceOf(controllerName(number), kind);
        since = since ? since : other;
    };
    for (const char *kind : {"mute", "silence", "loss", "corrupt"})
        take(controller, kind);
    for (int other = 0; other < robot_.robot.controllers(); ++other) {
        if (robot_.lineOf(other) == robot_.lineOf(controller))
            take(other, "echo");
    }
    return since;
}

bool StandJudge::isGuarded(int controller) const {
    return robot_.robot.controller(controller).timeout() > 0 &&
           !sinceOf(controllerName(controller), "stuck_timeout");
}

// Until a line has shown that a controller does not obey, and margin; three readings, which may take 0.1 s
// each.
double StandJudge::seeing(int controller) const {
    const int line = robot_.lineOf(controller);
    bool slow = sinceOf("line" + std::to_string(line + 1), "adapter").has_value();
    for (int other = 0; other < robot_.robot.controllers(); ++other)
        slow = slow || (robot_.lineOf(other) == line && sinceOf(controllerName(other), "slow"));
    return slow ? 1.0 : 0.6;
}

// How much longer the wheels of a controller may turn, as it is now.
void StandJudge::extend(int controller) {
    double &deadline = deadline_[std::size_t(controller)];
    const double now = time(), timeout = robot_.robot.controller(controller).timeout();
    const auto allow = [&](double until, const char *excuse) {
        if (until > deadline) {
            deadline = until;
            excuse_ = excuse;
        }
    };
    for (const char *kind : {"silence", "brownout", "restart"}) {
        if (const auto since = sinceOf(controllerName(controller), kind); since && *since + rolling > ended_)
            allow(std::max(ended_, *since) + rolling, "rolls without power");
    }
    const double silence = std::max(longestSilence, timeout + margin);
    if (sinceOf(controllerName(controller), damage)) { // any command may have become any other
        if (now > ended_ + reaction + braking() && rim(2 * controller) + rim(2 * controller + 1) > standing)
            beyond_.insert("hears damaged bytes without a checksum");
        allow(now + silence + 2 * reaction + fastest() / deceleration_, "beyond");
    }
    const auto unreachable = unreachableSince(controller), disobedient = disobedientSince(controller);
    if (!unreachable && !disobedient)
        return;
    // It is unreachable: its time-out runs. It disobeys: first that must be seen, and then its line falls
    // silent.
    const bool times = isGuarded(controller);
    const double runs = unreachable ? *unreachable + timeout + margin + braking() : 0;
    const double seen = disobedient ? std::max(ended_, *disobedient) + 1.5 * braking() + timeout +
                                          seeing(controller) + stalledFor_
                                    : 0;
    if (!times && rim(2 * controller) + rim(2 * controller + 1) > standing) {
        if (now > std::max(runs, seen) && now > deadline)
            beyond_.insert(unreachable ? "cannot be reached and has no time-out"
                                       : "disobeys and has no time-out");
        // An attempt must be seen to fail before the silence; then comes the next one.
        allow(now + seeing(controller) + (robot_.lines() > 1 ? 1 : 2) * silence + reaction + braking(),
              "beyond");
    } else {
        allow(std::max(runs, seen), "its own time-out");
    }
}

void StandJudge::watch() {
    const double now = time();
    if (justified_ && !robot_.engine->drive().haltReason().isEmpty() && !stalledSince_)
        endJustification("the motor control halted: " + robot_.engine->drive().haltReason().toStdString());
    if (const auto number = lostController())
        endJustification(controllerName(*number) + " has not been heard for " + print("%g s", lost));
    if (justified_ && now >= until_)
        endJustification("no command came");
    watchGuard();
    watchRunaways(now - last_);
    stalledFor_ += stalledSince_ ? now - last_ : 0;
    last_ = now;
    if (justified_)
        return;
    for (int controller = 0; controller < robot_.robot.controllers(); ++controller) {
        extend(controller);
        if (disobedientSince(controller))
            disobeyed_[std::size_t(controller)] = now;
        const bool creeps = now < disobeyed_[std::size_t(controller)] + reaction &&
                            now < std::max(deadline_[std::size_t(controller)], reconfigured_) + creepingSeen;
        const double limit = creeps ? creeping : standing;
        for (int wheel = 2 * controller; wheel < 2 * controller + 2; ++wheel) {
            if (rim(wheel) <= limit)
                continue;
            double &slowest = slowest_[excuse_];
            slowest = std::max(slowest, now - ended_ - braking());
            if (now > deadline_[std::size_t(controller)])
                fail(print("%s turns with %.2f m/s at %.2f s; no longer justified from %.2f s on (%s), it "
                           "should have stood by %.2f s",
                           wheelNames[wheel], rim(wheel), now, ended_, why_.c_str(),
                           deadline_[std::size_t(controller)]));
        }
    }
}

// Of a controller that is not heard nobody knows what it does: to drive on is not justified.
std::optional<int> StandJudge::lostController() const {
    for (int controller = 0; controller < robot_.robot.controllers(); ++controller) {
        const auto since = unheardSince(controller);
        if (since && !stalledSince_ && time() > std::max(*since, resumed_) + lost)
            return controller;
    }
    return std::nullopt;
}

void StandJudge::watchGuard() {
    hermes::motorcontrol::DriveEngine &engine = *robot_.engine;
    bool drivable = !stalledSince_;
    for (int controller = 0; controller < robot_.robot.controllers(); ++controller)
        drivable = drivable && engine.controller(controller).isReady();
    for (int controller = 0; controller < robot_.robot.controllers(); ++controller) {
        const bool swapped = sinceOf("controllers", "swapped").has_value();
        const bool guarded = robot_.robot.controller(swapped ? 1 - controller : controller).timeout() > 0 ||
                             (swapped && robot_.lines() > 1);
        double &seconds = unguardedFor_[std::size_t(controller)];
        seconds = guarded || !drivable ? 0 : seconds + time() - last_;
        if (seconds > unguarded)
            fail(controllerName(controller) +
                 print(" is ready without a time-out of its own at %.2f s", time()));
    }
}

void StandJudge::watchRunaways(double step) {
    if (std::exchange(resets_, robot_.engine->drive().resets()) != robot_.engine->drive().resets())
        ranAway_ = {};
    for (int wheel = 0; wheel < 2 * robot_.robot.controllers() && justified_ && !stalledSince_; ++wheel) {
        double &seconds = ranAway_[std::size_t(wheel)];
        seconds += rim(wheel) > runaway ? step : 0;
        if (seconds > hold_ + reaction + seeing(wheel / 2) / 2)
            fail(print("%s was faster than any command for %.2f s until %.2f s, and it is no fault",
                       wheelNames[wheel], seconds, time()));
    }
}

void StandJudge::fail(const std::string &what) {
    if (failure_.empty())
        failure_ = what;
}

} // namespace campaign
