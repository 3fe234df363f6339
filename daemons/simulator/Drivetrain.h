#pragma once

#include "daemons/simulator/MotorKinds.h"
#include "daemons/simulator/RobotBody.h"

#include <algorithm>

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

/// What drives the robot: motor controllers with two motors each, four wheels, a battery. Time comes from
/// outside.
class Drivetrain {
public:
    /// Which motor turns a wheel.
    struct Mount {
        int controller = 0;
        int motor = 0;
        bool reversed = false; ///< positive counts drive the robot backward
    };
    struct Options : MotorOptions {
        WheelBase base;
        /// As in WheelBase; a single controller turns the wheels of the second one, too.
        std::array<Mount, 4> wheels{{{0, 0}, {0, 1}, {1, 0}, {1, 1}}};
        double countsPerTurn = 38000;
        double slip = 0;       ///< share of the wheels' way that the robot does not make
        double slipSpread = 0; ///< standard deviation of each wheel's slip, drawn anew for each metre
        std::uint64_t seed = 1;
        bool ownLines = false; ///< each controller has a line of its own; else both share line 0
        Battery::Options battery;
    };

    Drivetrain()
        : Drivetrain(Options()) {}
    explicit Drivetrain(const Options &options);

    /// Bytes from a line (0 or 1), now: seconds of any clock; gives what is answered, in order.
    std::vector<MotorEmulator::Answer> receive(int line, const std::uint8_t *data, std::size_t size,
                                               double now);
    /// Lets time pass; gives how the wheels move the robot.
    Twist2D advance(double seconds);

    int controllers() const { return int(controllers_.size()); }
    MotorEmulator &controller(int number) { return *controllers_[std::size_t(number)]; }
    const MotorEmulator &controller(int number) const { return *controllers_[std::size_t(number)]; }
    /// The motor of a wheel.
    MotorChannel &wheel(int number) {
        const Mount &mount = options_.wheels[std::size_t(number)];
        return controller(mount.controller).channel(mount.motor);
    }
    /// Position of the steering servo, 0 to 1, once its controller was told one.
    std::optional<double> servo() const { return controller(0).servo(); }
    Battery &battery() { return battery_; }
    const Battery &battery() const { return battery_; }
    void setSlip(double share) { options_.slip = share; }
    /// The two controllers have exchanged their addresses.
    void setSwapped(bool swapped) {
        for (std::size_t i = 0; i < controllers_.size(); ++i)
            controllers_[i]->setAddress(options_.controller[swapped ? 1 - i : i].address);
    }
    /// The host's adapter of a line (0 or 1) hands on what it receives in bunches, each so many seconds after
    /// its first byte, as the latency timer of an FTDI chip does.
    void setLatency(int line, double seconds) { latency_[std::size_t(line)] = seconds; }
    /// rad/s, positive forward.
    std::array<double, 4> wheelSpeeds() const;
    bool isMoving() const;

private:
    void delayAnswer(MotorEmulator::Answer &answer, int line, double now);
    /// The wheels' speeds less their slip.
    std::array<double, 4> gripping(double seconds);

    /// What lies under a wheel.
    struct Ground {
        double slip = 0; ///< besides that of all wheels
        double left = 0; ///< metres to the next patch
    };
    Options options_;
    std::vector<std::unique_ptr<MotorEmulator>> controllers_;
    Battery battery_;
    std::mt19937_64 random_;
    std::array<Ground, 4> grounds_;
    std::array<double, 2> latency_{}, bunchEnds_{}; // of each line; seconds
};

} // namespace hermes::simulator
