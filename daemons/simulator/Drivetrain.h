#pragma once

#include "daemons/simulator/ArduinoEmulator.h"
#include "daemons/simulator/RoboClawEmulator.h"
#include "daemons/simulator/RobotBody.h"

#include <algorithm>
#include <optional>
#include <random>

namespace hermes::simulator {

/// A battery whose voltage falls as it is emptied, and under load: evenly at first, and with the last of the
/// charge it collapses. By default two lead-acid batteries in series (thesis 4.1.2).
class Battery {
public:
    struct Options {
        double full = 25.4;  ///< V, without load
        double empty = 23.4; ///< V, without load, before it collapses
        double capacity_Ah = 26;
        double resistance = 0.02; ///< ohm
    };

    Battery() = default;
    explicit Battery(const Options &options)
        : options_(options) {}

    /// 1 is full, 0 empty.
    void setCharge(double share) { charge_ = std::clamp(share, 0.0, 1.0); }
    double charge() const { return charge_; }
    void draw(double amperes, double seconds) {
        current_ = amperes;
        setCharge(charge_ - amperes * seconds / 3600 / options_.capacity_Ah);
    }
    double voltage() const {
        const double resting = options_.empty + (options_.full - options_.empty) * charge_;
        const double collapsed =
            std::max(0.0, options_.empty - exhausted) * std::max(0.0, 1 - charge_ / last);
        return std::max(0.0, resting - collapsed - current_ * options_.resistance);
    }

private:
    static constexpr double last = 0.05;    // of the charge
    static constexpr double exhausted = 20; // V, without load and charge

    Options options_;
    double charge_ = 1;
    double current_ = 0;
};

/// What drives the robot: two RoboClaws with two motors each, or an Arduino with one for each side; four
/// wheels, a battery. Time comes from outside.
class Drivetrain {
public:
    static constexpr int controllers = 2;
    /// Which motor turns a wheel.
    struct Mount {
        int controller = 0;
        int motor = 0;
        bool reversed = false; ///< positive counts drive the robot backward
    };
    struct Options {
        WheelBase base;
        std::array<Mount, 4> wheels{{{0, 0}, {0, 1}, {1, 0}, {1, 1}}}; ///< as in WheelBase
        double countsPerTurn = 38000;
        double slip = 0;       ///< share of the wheels' way that the robot does not make
        double slipSpread = 0; ///< standard deviation of each wheel's slip, drawn anew for each metre
        std::uint64_t seed = 1;
        bool ownLines = false; ///< each controller has a line of its own; else both share line 0
        std::array<RoboClawEmulator::Options, controllers> controller = twoAddresses();
        std::optional<ArduinoEmulator::Options> arduino; ///< instead of the controllers, on line 0
        Battery::Options battery;
    };

    Drivetrain()
        : Drivetrain(Options()) {}
    explicit Drivetrain(const Options &options)
        : options_(options)
        , controllers_{RoboClawEmulator(options.controller[0]), RoboClawEmulator(options.controller[1])}
        , arduino_(options.arduino)
        , battery_(options.battery)
        , random_(options.seed) {}

    /// Bytes from a line (0 or 1), now: seconds of any clock; gives what is answered, in order.
    std::vector<RoboClawEmulator::Answer> receive(int line, const std::uint8_t *data, std::size_t size,
                                                  double now);
    /// Lets time pass; gives how the wheels move the robot.
    Twist2D advance(double seconds);

    RoboClawEmulator &controller(int number) { return controllers_[std::size_t(number)]; }
    const RoboClawEmulator &controller(int number) const { return controllers_[std::size_t(number)]; }
    /// None where the controllers drive.
    std::optional<ArduinoEmulator> &arduino() { return arduino_; }
    /// The motor of a wheel.
    MotorChannel &wheel(int number) {
        if (arduino_)
            return arduino_->channel(number % 2);
        const Mount &mount = options_.wheels[std::size_t(number)];
        return controller(mount.controller).channel(mount.motor);
    }
    Battery &battery() { return battery_; }
    const Battery &battery() const { return battery_; }
    void setSlip(double share) { options_.slip = share; }
    /// The controllers have exchanged their addresses.
    void setSwapped(bool swapped) {
        for (std::size_t i = 0; i < controllers_.size(); ++i)
            controllers_[i].setAddress(options_.controller[swapped ? 1 - i : i].address);
    }
    /// The host's adapter of a line (0 or 1) hands on what it receives in bunches, each so many seconds after
    /// its first byte, as the latency timer of an FTDI chip does.
    void setLatency(int line, double seconds) { latency_[std::size_t(line)] = seconds; }
    /// rad/s, positive forward.
    std::array<double, 4> wheelSpeeds() const;
    bool isMoving() const;

private:
    void delayAnswer(RoboClawEmulator::Answer &answer, int line, double now);
    static std::array<RoboClawEmulator::Options, controllers> twoAddresses() {
        std::array<RoboClawEmulator::Options, controllers> options;
        options[1].address = std::uint8_t(options[0].address + 1);
        return options;
    }
    /// The wheels' speeds less their slip.
    std::array<double, 4> gripping(double seconds);

    /// What lies under a wheel.
    struct Ground {
        double slip = 0; ///< besides that of all wheels
        double left = 0; ///< metres to the next patch
    };
    Options options_;
    std::array<RoboClawEmulator, controllers> controllers_;
    std::optional<ArduinoEmulator> arduino_;
    Battery battery_;
    std::mt19937_64 random_;
    std::array<Ground, 4> grounds_;
    std::array<double, 2> latency_{}, bunchEnds_{}; // of each line; seconds
};

} // namespace hermes::simulator
