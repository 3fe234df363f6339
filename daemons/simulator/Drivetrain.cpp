#include "daemons/simulator/Drivetrain.h"
#include "vectorlib/geometry/Angle.h"

#include <cmath>

namespace hermes::simulator {

namespace {

constexpr double electronics = 0.3; // A that are always drawn
constexpr double patch = 1;         // metres of like ground under a wheel

} // namespace

Drivetrain::Drivetrain(const Options &options)
    : options_(options)
    , battery_(options.battery)
    , random_(options.seed) {
    const MotorKind &kind = motorKind(options.kind);
    for (int number = 0; number < kind.controllers; ++number)
        controllers_.push_back(kind.make(options, std::size_t(number)));
    for (Mount &mount : options_.wheels)
        mount.controller = std::min(mount.controller, controllers() - 1);
}

std::vector<MotorEmulator::Answer> Drivetrain::receive(int line, const std::uint8_t *data, std::size_t size,
                                                       double now) {
    std::vector<MotorEmulator::Answer> answers;
    for (std::size_t i = 0; i < size; ++i) {
        for (int number = 0; number < controllers(); ++number) {
            if (line != (options_.ownLines ? number : 0))
                continue;
            for (MotorEmulator::Answer answer : controller(number).receive(data[i], now)) {
                delayAnswer(answer, line, now);
                answers.push_back(answer);
            }
        }
    }
    return answers;
}

void Drivetrain::delayAnswer(MotorEmulator::Answer &answer, int line, double now) {
    const double latency = latency_[std::size_t(line)];
    if (!(latency > 0))
        return;
    double &end = bunchEnds_[std::size_t(line)];
    const double arrives = now + answer.delay;
    if (arrives > end || end > arrives + latency) // the second: another clock
        end = arrives + latency;
    answer.delay = end - now;
}

Twist2D Drivetrain::advance(double seconds) {
    double current = electronics;
    for (const auto &device : controllers_) {
        device->advance(seconds, battery_.voltage());
        for (const int motor : {0, 1}) // the bridge takes from the battery what the duty lets through
            current += device->channel(motor).current() * device->channel(motor).duty();
    }
    battery_.draw(current, seconds);
    return options_.base.twistOf(gripping(seconds), servo().value_or(options_.base.servoCentre));
}

std::array<double, 4> Drivetrain::gripping(double seconds) {
    std::array<double, 4> speeds = wheelSpeeds();
    for (std::size_t i = 0; i < speeds.size(); ++i) {
        Ground &ground = grounds_[i];
        ground.left -= std::abs(speeds[i]) * options_.base.radius * seconds;
        if (options_.slipSpread > 0 && ground.left < 0)
            ground = {std::normal_distribution<double>(0, options_.slipSpread)(random_), patch};
        speeds[i] *= 1 - std::clamp(options_.slip + ground.slip, 0.0, 1.0);
    }
    return speeds;
}

std::array<double, 4> Drivetrain::wheelSpeeds() const {
    std::array<double, 4> speeds;
    for (std::size_t i = 0; i < speeds.size(); ++i) {
        const Mount &mount = options_.wheels[i];
        const MotorChannel &motor = controller(mount.controller).channel(mount.motor);
        speeds[i] = (mount.reversed ? -1 : 1) * motor.speed() * 2 * vectorlib::pi / options_.countsPerTurn;
    }
    return speeds;
}

bool Drivetrain::isMoving() const {
    for (const double speed : wheelSpeeds()) {
        if (speed != 0)
            return true;
    }
    return false;
}

} // namespace hermes::simulator
