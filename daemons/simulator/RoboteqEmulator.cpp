#include "daemons/simulator/RoboteqEmulator.h"

#include <sstream>

namespace hermes::simulator {

namespace {

constexpr double fullCommand = 1000;
constexpr std::size_t longestLine = 64; // what comes beyond it is not in the fact sheet: here it is lost

std::string wholeText(double value) {
    return std::to_string(std::llround(value));
}

} // namespace

RoboteqEmulator::RoboteqEmulator(const Options &options)
    : MotorEmulator(options)
    , options_(options)
    , watchdog_ms_(options.timeout * 1000) {}

void RoboteqEmulator::hear(std::uint8_t byte) {
    const char letter = char(noisy(byte));
    if (echoes_)
        sendPlain(std::string(1, letter));
    if (letter != '\r') {
        if (letter != '\n' && line_.size() < longestLine)
            line_ += letter;
        return;
    }
    const std::string told = execute(std::exchange(line_, {}));
    if (!told.empty())
        sendPlain(told + '\r');
}

// The fact sheet shows only some lines. That an answer repeats the name of what it tells, what stands for a
// missing number, and the units of ?V and ?A are a guess from the usual use.
std::string RoboteqEmulator::execute(const std::string &line) {
    if (line.empty())
        return {};
    std::istringstream words(line.substr(1));
    std::string name;
    long first = 0, second = 0;
    words >> name;
    const bool one = bool(words >> first), two = bool(words >> second);
    ++counts_.requests;
    if (line[0] == '!' && name == "G" && two && (first == 1 || first == 2)) {
        silence_ = 0;
        isLate_ = false;
        if (!faults_.latched)
            targets_[std::size_t(first - 1)] =
                std::clamp(double(second) / fullCommand, -1.0, 1.0) * options_.motor.fullSpeed;
        return "+";
    }
    if (line[0] == '^' && one && configure(name, double(first)))
        return "+";
    std::string told;
    if (line[0] == '~' && (name == "RWD" || name == "ECHOF"))
        told = name == "RWD" ? wholeText(watchdog_ms_) : wholeText(echoes_ ? 0 : 1);
    if (line[0] == '?')
        told = query(name, int(first));
    if (!told.empty())
        return name + '=' + told;
    --counts_.requests;
    ++counts_.unknown;
    return "-";
}

bool RoboteqEmulator::configure(const std::string &name, double value) {
    if (name == "ECHOF")
        echoes_ = value == 0;
    else if (name == "RWD" && value >= 0 && value <= 65535)
        watchdog_ms_ = value;
    else
        return false;
    return true;
}

std::string RoboteqEmulator::query(const std::string &name, int channel) const {
    const auto ofChannels = [channel](const std::string &one, const std::string &two) {
        return channel == 1 ? one : channel == 2 ? two : one + ':' + two;
    };
    const auto &[left, right] = channels_;
    if (name == "FID")
        return "Roboteq v1.8 simulated";
    if (name == "C")
        return ofChannels(wholeText(std::int32_t(std::uint32_t(left.count()))),
                          wholeText(std::int32_t(std::uint32_t(right.count()))));
    if (name == "A")
        return ofChannels(wholeText(left.current() * 10), wholeText(right.current() * 10));
    if (name == "V") // of its driver, of the battery, of its supply of 5 V
        return "120:" + wholeText(voltage_ * 10) + ":5000";
    return {};
}

void RoboteqEmulator::turn(double seconds) {
    const bool late = watchdog_ms_ > 0 && silence_ >= timeout() && !faults_.stuckTimeout;
    const bool drove = targets_[0] != 0 || targets_[1] != 0;
    counts_.timeouts += late && !isLate_ && drove;
    isLate_ = late;
    if (isDead() || (isLate_ && faults_.latched)) // that fault ends with the time-out
        targets_ = {};
    for (std::size_t i = 0; i < channels_.size(); ++i) {
        if (isLate_ || targets_[i] == 0)
            channels_[i].stop();
        else
            channels_[i].driveSpeed(targets_[i]);
        channels_[i].advance(seconds, voltage_, !isDead());
    }
}

void RoboteqEmulator::reset() {
    echoes_ = true;
    isLate_ = false;
    watchdog_ms_ = options_.timeout * 1000;
    targets_ = {};
    line_.clear();
}

} // namespace hermes::simulator
