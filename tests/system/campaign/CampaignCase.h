#pragma once

#include <QJsonObject>
#include <QStringList>

#include <string>
#include <vector>

namespace campaign {

/// Something that breaks, and when it is mended; seconds since the start. Devices and kinds are those of
/// sim.fault, and "silence" of a controller is one without power.
struct Fault {
    std::string device;
    std::string kind;
    double begin = 0;
    double end = 0;
    double amount = 0; ///< share, seconds or counts
};

/// What somebody does; seconds since the start.
struct Step {
    double time = 0;
    std::string action;
    double amount = 0; ///< seconds
};

/// What a client does while nothing else is said: it acquires the control whenever it has lost it and drives
/// at 20 Hz.
struct Case {
    std::uint64_t seed = 0;
    std::string kind = "roboclaw"; ///< what drives the wheels, as the simulator names it
    bool twoLines = false;
    bool movesAtFirst = false; ///< somebody else has set the wheels going, without a time-out
    bool resets = false;       ///< the client releases emergency stop and faults whenever it is refused
    bool stamps = false;       ///< it tells when a command was made
    std::string firmware = "4.2.8";
    double vx = 0.5, vy = 0, omega = 0;
    std::string steering;   ///< "" drives on; "to and fro", or "taps": every other period it tells to stand
    double steerPeriod = 0; ///< seconds
    double lease_s = 1;
    QJsonObject settings; ///< those that are not the default
    std::vector<Fault> faults;
    std::vector<Step> steps;
    double duration = 6; ///< then everything is mended, and the robot shall drive again

    /// The same for the same seed.
    static Case draw(std::uint64_t seed, const std::string &kind);
    bool isUndisturbed() const { return faults.empty() && steps.empty() && steering.empty(); }
    /// Times the velocity, at that time of the case.
    double steered(double time) const;
    /// For people: one line a thing that happens, in their order.
    std::string script() const;
};

/// Every "device kind" that a case may have, devices of a sort counted once: "controller mute".
QStringList everyFault(const std::string &kind);
std::string sortOf(const Fault &fault);
/// All actions of steps.
const std::vector<std::string> &everyAction();

} // namespace campaign
