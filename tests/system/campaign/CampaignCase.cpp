#include "CampaignCase.h"

#include "daemons/simulator/MotorKinds.h"

#include <QJsonDocument>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace campaign {

namespace {

using namespace hermes::simulator;

const std::vector<std::string> roboClawKinds{
    "mute",           "deaf",   "latched",          "loss",        "corrupt",
    "slow",           "echo",   "stuck_timeout",    "brownout",    "silence",
    "emergency_stop", "driver", "over_temperature", "over_current"};
const std::vector<std::string> wheelKinds{"blocked", "encoder", "jump", "backward"};
const std::vector<std::string> wheels{"front_left", "front_right", "rear_left", "rear_right"};
const std::vector<std::string> actions{"falls silent",
                                       "stops",
                                       "is stopped by another",
                                       "emergency stop",
                                       "loses its connection",
                                       "gives the control back",
                                       "is taken over",
                                       "changes settings",
                                       "the process stands still",
                                       "is fought by a rival",
                                       "the motor control is killed"};

bool isSingle(const std::string &kind) {
    return motorKind(kind).controllers == 1;
}

std::vector<std::string> controllerKinds(const std::string &kind) {
    const auto &faults = motorKind(kind).faults;
    return kind == "roboclaw" ? roboClawKinds : std::vector<std::string>(faults.begin(), faults.end());
}

/// Numbers that are the same on every machine.
class Dice {
public:
    explicit Dice(std::uint64_t seed)
        : random_(seed * 0x9E3779B97F4A7C15ULL + 1) {}

    int below(int limit) { return int(random_() % std::uint64_t(limit)); }
    bool chance(double probability) { return below(1000000) < probability * 1000000; }
    /// Rounded, so that scripts are short.
    double between(double least, double most, double step = 0.01) {
        const int steps = int(std::lround((most - least) / step));
        return least + step * below(steps + 1);
    }
    template <typename Value>
    const Value &of(const std::vector<Value> &values) {
        return values[std::size_t(below(int(values.size())))];
    }

private:
    std::mt19937_64 random_;
};

double amountOf(const std::string &kind, Dice &dice) {
    if (kind == "loss" || kind == "corrupt")
        return dice.chance(0.5) ? 1 : dice.between(0.1, 0.9, 0.1);
    if (kind == "slow")
        return dice.between(0.005, 0.15, 0.005);
    if (kind == "adapter")
        return dice.between(0.002, 0.05, 0.002);
    if (kind == "brownout")
        return dice.between(0.02, 1, 0.02);
    if (kind == "restart")
        return ArduinoEmulator::restartTime;
    if (kind == "jump")
        return dice.between(-3e6, 3e6, 100000);
    return 0;
}

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

void drawSettings(Case &c, Dice &dice) {
    QJsonObject safety, controllers, faults, frame;
    if (dice.chance(0.6))
        controllers["timeout_s"] = dice.between(0.1, 0.5, 0.1);
    if (dice.chance(0.4))
        safety["command_timeout_s"] = dice.between(0.1, 0.6, 0.05);
    const double deceleration = dice.chance(0.4) ? dice.between(2, 8, 0.5) : 4;
    safety["deceleration"] = deceleration;
    // Longer than braking from the largest speed, 2.36 m/s at the rim, takes.
    faults["encoder_hold_s"] =
        std::max(0.7, std::ceil(24 / deceleration) / 10 + (dice.chance(0.3) ? 0.3 : 0));
    if (dice.chance(0.3))
        faults["hold_s"] = dice.between(0.1, 1.5, 0.1);
    if (dice.chance(0.4))
        frame["layout"] = "differential";
    c.settings = {{"safety", safety}, {"controllers", controllers}, {"faults", faults}, {"frame", frame}};
    c.twoLines = dice.chance(0.5);
    c.vx = dice.between(-0.7, 0.7, 0.1);
    c.vy = dice.chance(0.3) && frame.isEmpty() ? dice.between(-0.3, 0.3, 0.1) : 0;
    c.omega = dice.chance(0.3) ? dice.between(-0.6, 0.6, 0.1) : 0;
    if (std::abs(c.vx) < 0.2)
        c.vx = 0.5;
    c.lease_s = dice.chance(0.5) ? 1 : dice.between(0.3, 10, 0.1);
    c.resets = dice.chance(0.5);
    c.stamps = dice.chance(0.3);
    c.movesAtFirst = dice.chance(0.08);
    c.firmware = dice.of<std::string>({"4.1.28", "4.2.8", "4.2.8", "4.3.6"});
    if (isSingle(c.kind)) {
        controllers["kind"] = QString::fromStdString(c.kind);
        if (c.kind == "arduino")
            controllers["timeout_s"] = ArduinoEmulator::Options().timeout;
        if (c.kind == "opencr") {
            controllers["timeout_s"] = OpenCrEmulator::Options().timeout;
            frame["counts_per_turn"] = OpenCrEmulator::countsPerTurn;
            c.settings["pid"] = QJsonObject{{"qpps", 16000}}; // the same speed as with the usual counts
        }
        if (c.kind != "arduino")
            controllers["count"] = 1;
        frame["layout"] = "differential";
        c.settings["controllers"] = controllers;
        c.settings["frame"] = frame;
        c.twoLines = c.movesAtFirst = false;
        c.vy = 0;
    }
}

/// Nothing of a second controller, or of wheels that turn with those in front.
void fitSingle(Fault &fault, const std::string &kind) {
    const std::vector<std::string> kinds = controllerKinds(kind);
    if (fault.device == "controllers")
        fault = {"battery", "charge", fault.begin, fault.end, 0};
    if (fault.device == "controller2" || fault.device == "line2")
        fault.device.back() = '1';
    if (fault.device.rfind("rear", 0) == 0)
        fault.device.replace(0, 4, "front");
    if (fault.kind == "backward" && kind == "opencr") // its encoders are within its servos
        fault.kind = "blocked";
    if (fault.device == "controller1" && std::find(kinds.begin(), kinds.end(), fault.kind) == kinds.end())
        fault.kind = "deaf";
}

Fault drawFault(Dice &dice, const Case &c) {
    const std::vector<std::string> kinds = controllerKinds(c.kind);
    Fault fault;
    const int sort = dice.below(20);
    if (sort < 13) {
        fault.device = dice.chance(0.5) ? "controller1" : "controller2";
        fault.kind = dice.chance(0.25) ? dice.of<std::string>({"deaf", "latched", "mute"}) : dice.of(kinds);
    } else if (sort < 16) {
        fault.device = c.twoLines && dice.chance(0.5) ? "line2" : "line1";
        fault.kind = dice.chance(0.5) ? "pulled" : "adapter";
    } else if (sort < 18) {
        fault.device = dice.of(wheels);
        fault.kind = dice.of(wheelKinds);
    } else {
        fault.device = sort == 18 ? "controllers" : "battery";
        fault.kind = sort == 18 ? "swapped" : "charge";
    }
    if (isSingle(c.kind))
        fitSingle(fault, c.kind);
    fault.amount = amountOf(fault.kind, dice);
    if (fault.kind == "corrupt" && !motorKind(c.kind).checksums && dice.chance(0.5))
        fault.amount = dice.between(0.002, 0.02, 0.002); // of the bytes
    fault.begin = dice.chance(0.2) ? 0 : dice.chance(0.2) ? dice.between(0, 0.5) : dice.between(1, 4.5);
    fault.end = fault.begin + (dice.chance(0.3) ? dice.between(0.03, 0.5) : dice.between(0.5, 4));
    if (fault.kind == "brownout" || fault.kind == "restart")
        fault.end = fault.begin + fault.amount;
    return fault;
}

/// Without those that come too late, or while the device has the same already.
std::vector<Fault> possible(const std::vector<Fault> &drawn, double duration) {
    const auto sort = [](const Fault &f) { return f.device + (f.kind == "mute" ? "loss" : f.kind); };
    std::vector<Fault> faults;
    for (Fault fault : drawn) {
        fault.end = std::min(fault.end, duration);
        const bool again = std::any_of(faults.begin(), faults.end(), [&](const Fault &f) {
            return sort(f) == sort(fault) && f.begin <= fault.end && fault.begin <= f.end;
        });
        if (fault.begin < duration && !again)
            faults.push_back(fault);
    }
    return faults;
}

} // namespace

QStringList everyFault(const std::string &kind) {
    QStringList all{"line pulled", "line adapter", "battery charge"};
    if (!isSingle(kind))
        all.append("controllers swapped");
    for (const std::string &fault : controllerKinds(kind))
        all.append(QString::fromStdString("controller " + fault));
    for (const std::string &fault : wheelKinds)
        if (fault != "backward" || kind != "opencr")
            all.append(QString::fromStdString("wheel " + fault));
    return all;
}

std::string sortOf(const Fault &fault) {
    const bool wheel = std::find(wheels.begin(), wheels.end(), fault.device) != wheels.end();
    std::string device = wheel ? "wheel" : fault.device;
    while (std::isdigit(static_cast<unsigned char>(device.back())))
        device.pop_back();
    return device + " " + fault.kind;
}

const std::vector<std::string> &everyAction() {
    return actions;
}

Case Case::draw(std::uint64_t seed, const std::string &kind) {
    Dice dice(seed);
    Case c;
    c.seed = seed;
    c.kind = kind;
    drawSettings(c, dice);
    const int faults = dice.chance(0.08) ? 0 : 1 + dice.below(3);
    for (int i = 0; i < faults; ++i) {
        Fault fault = drawFault(dice, c);
        c.faults.push_back(fault);
        if (fault.device.rfind("controller", 0) == 0 && fault.device != "controllers" && dice.chance(0.35) &&
            !isSingle(kind)) {
            fault.device = fault.device == "controller1" ? "controller2" : "controller1"; // both
            c.faults.push_back(fault);
        }
        if (dice.chance(0.15)) { // twice
            const double length = fault.end - fault.begin;
            fault.begin = fault.end + dice.between(0.05, 1);
            fault.end = fault.begin + length;
            c.faults.push_back(fault);
        }
    }
    const int steps = faults == 0 ? dice.below(3) : dice.below(4);
    for (int i = 0; i < steps; ++i) {
        Step step{dice.between(0.8, 5.2), dice.of(actions), dice.between(0.05, 2)};
        c.steps.push_back(step);
        if (step.action == "the process stands still" &&
            dice.chance(0.5)) // and its client falls silent meanwhile
            c.steps.push_back(
                {step.time + dice.between(0, 1) * step.amount, "falls silent", dice.between(0.3, 3)});
    }
    if (dice.chance(0.15)) { // adapters as they come
        for (const char *line : {"line1", "line2"}) {
            if (line[4] == '1' || c.twoLines)
                c.faults.push_back({line, "adapter", 0, c.duration, dice.between(0.012, 0.02, 0.001)});
        }
    }
    c.faults = possible(c.faults, c.duration);
    if (dice.chance(0.4)) {
        c.steering = dice.of<std::string>({"to and fro", "taps"});
        c.steerPeriod = dice.between(0.05, 1, 0.05);
    }
    std::sort(c.steps.begin(), c.steps.end(), [](const Step &a, const Step &b) { return a.time < b.time; });
    return c;
}

double Case::steered(double time) const {
    const bool other = !steering.empty() && time < duration && int(time / steerPeriod) % 2 != 0;
    return !other ? 1 : steering == "taps" ? 0 : -1;
}

std::string Case::script() const {
    std::multimap<double, std::string> lines;
    for (const Fault &f : faults) {
        const std::string amount = f.amount != 0 ? " " + number(f.amount) : "";
        lines.emplace(f.begin, f.device + ": " + f.kind + amount);
        if (f.kind != "jump" && f.kind != "brownout" && f.kind != "restart")
            lines.emplace(f.end, f.device + ": " + f.kind + " ends");
    }
    for (const Step &s : steps)
        lines.emplace(
            s.time, (s.action.rfind("the ", 0) == 0 || s.action.rfind("emer", 0) == 0 ? "" : "the client ") +
                        s.action + " (" + number(s.amount) + " s)");
    std::string text = "  " + std::string(twoLines ? "two lines" : "one line") + ", " +
                       (kind == "roboclaw" ? "firmware " + firmware : kind) + ", drives " + number(vx) +
                       " m/s, " + number(vy) + " m/s, " + number(omega) + " rad/s, " +
                       (steering.empty() ? "" : steering + " every " + number(steerPeriod) + " s, ") +
                       "lease " + number(lease_s) + " s" + (resets ? ", resets faults" : "") +
                       (stamps ? ", stamps" : "") + (movesAtFirst ? ", wheels turn already" : "") +
                       "\n  settings " +
                       QJsonDocument(settings).toJson(QJsonDocument::Compact).toStdString() + "\n";
    for (const auto &[time, line] : lines) {
        char stamp[32];
        std::snprintf(stamp, sizeof stamp, "  %5.2f s  ", time);
        text += stamp + line + "\n";
    }
    return text;
}

} // namespace campaign
