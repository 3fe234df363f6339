#include "daemons/simulator/MotorEmulator.h"
#include "protocol/roboclaw/Status.h"

#include <utility>

namespace hermes::simulator {

namespace {

constexpr std::size_t longestAnswer = 64; // as drive::Bytes has it
constexpr std::pair<const char *, bool MotorEmulator::Faults::*> flags[] = {
    {"silence", &MotorEmulator::Faults::silent},
    {"deaf", &MotorEmulator::Faults::deaf},
    {"latched", &MotorEmulator::Faults::latched},
    {"echo", &MotorEmulator::Faults::echo},
    {"stuck_timeout", &MotorEmulator::Faults::stuckTimeout}};
constexpr std::pair<const char *, double MotorEmulator::Faults::*> amounts[] = {
    {"loss", &MotorEmulator::Faults::drop},
    {"mute", &MotorEmulator::Faults::drop},
    {"corrupt", &MotorEmulator::Faults::corrupt},
    {"slow", &MotorEmulator::Faults::delay}};
constexpr std::pair<const char *, std::uint32_t> statusBits[] = {
    {"emergency_stop", roboclaw::EmergencyStop},
    {"driver", roboclaw::DriverFaultM1},
    {"over_temperature", roboclaw::TemperatureError},
    {"over_current", roboclaw::OverCurrentWarningM1 | roboclaw::OverCurrentWarningM2}};

template <typename Table>
auto find(const Table &table, const std::string &kind) {
    return std::find_if(std::begin(table), std::end(table),
                        [&](const auto &entry) { return kind == entry.first; });
}

} // namespace

MotorEmulator::MotorEmulator(const Options &options)
    : channels_{MotorChannel(options.motor), MotorChannel(options.motor)}
    , random_(options.seed) {
    MotorChannel::Pid pid;
    pid.qpps = options.motor.fullSpeed;
    for (MotorChannel &channel : channels_)
        channel.setPid(pid);
}

bool MotorEmulator::setFault(const std::string &kind, double amount, bool on) {
    if (const auto flag = find(flags, kind); flag != std::end(flags))
        faults_.*flag->second = on;
    else if (const auto share = find(amounts, kind); share != std::end(amounts))
        faults_.*share->second = !on ? 0 : kind == "mute" ? 1 : amount;
    else if (const auto bit = find(statusBits, kind); bit != std::end(statusBits))
        faults_.status = on ? faults_.status | bit->second : faults_.status & ~bit->second;
    else if (kind != "brownout" && kind != "restart")
        return false;
    else if (on)
        restart(amount);
    return true;
}

std::vector<MotorEmulator::Answer> MotorEmulator::receive(std::uint8_t byte, double) {
    if (faults_.echo) {
        answers_.emplace_back();
        answers_.back().bytes.push(byte);
    }
    if (!isDead() && !faults_.deaf)
        hear(byte);
    return std::exchange(answers_, {});
}

void MotorEmulator::advance(double seconds, double voltage) {
    voltage_ = voltage;
    silence_ += seconds;
    startsIn_ = std::max(0.0, startsIn_ - seconds);
    turn(seconds);
}

void MotorEmulator::restart(double seconds) {
    reset();
    startsIn_ = seconds;
    for (MotorChannel &channel : channels_) {
        channel.stop();
        channel.setCount(0);
    }
}

void MotorEmulator::send(const std::uint8_t *data, std::size_t size, double late) {
    if (chance(faults_.drop))
        return;
    const std::size_t bit = chance(faults_.corrupt) ? random_() % (size * 8) : size * 8;
    for (std::size_t i = 0; i < size; ++i) {
        if (i % longestAnswer == 0)
            answers_.push_back({{}, faults_.delay + late});
        answers_.back().bytes.push(std::uint8_t(data[i] ^ (bit / 8 == i ? 1 << bit % 8 : 0)));
    }
}

void MotorEmulator::sendPlain(const std::string &text) {
    if (chance(faults_.drop))
        return;
    answers_.push_back({{}, faults_.delay});
    for (const char letter : text)
        answers_.back().bytes.push(noisy(std::uint8_t(letter)));
}

} // namespace hermes::simulator
