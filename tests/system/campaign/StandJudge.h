#pragma once

#include "CampaignCase.h"
#include "VirtualRobot.h"

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace campaign {

/// Checks one sentence: from the moment a command is no longer justified, every wheel stands within the
/// documented time, and stays. Times are seconds of the case.
///
/// That time is reaction and braking where a controller hears and obeys. Where only its own time-out can act
/// it is that of the time-out more, and where its bridge has no power the wheel rolls out. What no software
/// can do is counted by its name in beyond().
class StandJudge {
public:
    StandJudge(VirtualRobot &robot, double start)
        : robot_(robot)
        , start_(start) {}

    /// The robot now brakes with this (m/s^2), a command is good for so long, a wheel that turns without
    /// being told to is a fault after hold.
    void configure(double deceleration, double commandTimeout_s, double hold_s);
    void begin(const Fault &fault);
    void end(const Fault &fault);
    void setStalled(bool stalled);
    /// What is seen of slow motions begins anew.
    void reconfigure() { reconfigured_ = time(); }
    /// Another process has begun: it knows nothing of what the wheels did before.
    void restart() { ranAway_ = {}; }

    /// A command that was made then was accepted.
    void justify(double made);
    void endJustification(const std::string &why);
    /// The wheels turn already.
    void beginUnjustified(const std::string &why);
    /// After each step.
    void watch();

    bool isJustified() const { return justified_; }
    double fastest() const;
    const std::string &failure() const { return failure_; }
    /// What software cannot promise, as far as it happened.
    const std::set<std::string> &beyond() const { return beyond_; }
    /// The longest time, without that of braking, from the end of a justification until all stood, where a
    /// controller obeys, where only its time-out acts, where it rolls.
    const std::map<std::string, double> &slowest() const { return slowest_; }

private:
    static constexpr double standing = 0.005;   // m/s at the rim
    static constexpr double creeping = 0.03;    // m/s: slower is a motion only
    static constexpr double creepingSeen = 1.5; // when it has lasted
    static constexpr double reaction = 0.15;    // cycle, line, a repetition, lag of the motors
    static constexpr double margin = 0.1;       // of a time-out, and lag of the motors
    static constexpr double longestSilence =
        0.6;                               // of a line, between two attempts to stop what does not confirm
    static constexpr double rolling = 1.2; // without power
    static constexpr double runaway = 1.6; // m/s at the rim: no case tells a wheel to be so fast
    static constexpr double lost = 0.5;    // not heard for so long, a controller has been noticed
    static constexpr double unguarded =
        3; // without its time-out a controller may be driven no longer than that

    double time() const { return robot_.now() - start_; }
    double rim(int wheel) const;
    double braking() const { return speedAtEnd_ / deceleration_; }
    std::optional<double> sinceOf(const std::string &device, const std::string &kind) const;
    /// Since when the controller neither obeys nor knows, whatever is sent to it.
    std::optional<double> unreachableSince(int controller) const;
    std::optional<double> disobedientSince(int controller) const;
    std::optional<double> unheardSince(int controller) const;
    bool isGuarded(int controller) const;
    double seeing(int controller) const;
    void extend(int controller);
    std::optional<int> lostController() const;
    void watchGuard();
    /// Wheels far faster than any command, while the robot may drive.
    void watchRunaways(double step);
    void fail(const std::string &what);

    VirtualRobot &robot_;
    double start_;
    double deceleration_ = 4, commandTimeout_ = 0.25, hold_ = 0.7;
    std::map<std::pair<std::string, std::string>, double> active_; // since when
    std::optional<double> stalledSince_;
    double resumed_ = 0, reconfigured_ = 0;
    double exchanged_ = 0;  // when the controllers last exchanged their addresses
    double stalledFor_ = 0; // since the justification ended: time in which nobody can see what a wheel does

    bool justified_ = false;
    double until_ = 0;
    double ended_ = 0; // when the justification did
    double speedAtEnd_ = 0;
    std::string why_ = "nobody has driven yet";
    std::string excuse_ = "obeys";
    std::array<double, 2> deadline_{}, unguardedFor_{}, disobeyed_{-1, -1};
    std::array<double, 4> ranAway_{}; // for so long in all
    quint64 resets_ = 0;              // of the faults, seen
    std::string failure_;
    std::set<std::string> beyond_;
    std::map<std::string, double> slowest_;
    double last_ = 0;
};

} // namespace campaign
