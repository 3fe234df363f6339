#pragma once

#include "daemons/simulator/MotorChannel.h"
#include "protocol/drive/ReplyReader.h"

#include <array>
#include <random>
#include <string>
#include <vector>

namespace hermes::simulator {

/// A motor controller with two motors as it looks from its serial line: bytes in, answers out. Knows no line
/// and no clock.
class MotorEmulator {
public:
    struct Options {
        MotorChannel::Motor motor;
        std::uint64_t seed = 1; ///< of the faults
    };
    /// What it does wrong, as far as its kind can.
    struct Faults {
        bool silent = false;       ///< dead: hears nothing, does nothing, motors off
        bool deaf = false;         ///< hears nothing; drives on until its own time-out
        bool latched = false;      ///< acknowledges new set-points, but keeps the last one
        bool stuckTimeout = false; ///< its own time-out does not work
        bool echo = false;         ///< what it receives comes back before its answers
        double drop = 0;           ///< share of the answers that are not sent; 1: mute
        double corrupt = 0;        ///< share of the answers with one bit flipped; without checksums: of the
                                   ///< bytes, both ways
        double delay = 0;          ///< seconds by which each answer is late
        std::uint32_t status = 0;  ///< bits that are set besides its own, those of a RoboClaw
    };
    struct Answer {
        drive::Bytes bytes;
        double delay = 0; ///< seconds
    };
    struct Counts {
        std::uint64_t requests = 0; ///< carried out
        std::uint64_t crcErrors = 0;
        std::uint64_t unknown = 0;
        std::uint64_t timeouts = 0; ///< times that silence stopped the motors
    };

    virtual ~MotorEmulator() = default;

    /// One byte from the line, now: seconds of any clock, to know the gaps between bytes.
    virtual std::vector<Answer> receive(std::uint8_t byte, double now);
    /// Lets time pass. voltage: of the main battery.
    void advance(double seconds, double voltage);
    /// As after a brown-out: for so many seconds it is dead, then it answers as when it is switched on, with
    /// counts of 0.
    void restart(double seconds);
    /// Without its host it stops after so many seconds; 0: never.
    virtual double timeout() const = 0;
    /// Bits of errors and warnings, and degrees Celsius, where such a controller tells them.
    virtual std::optional<std::uint32_t> status() const { return {}; }
    virtual std::optional<double> temperature() const { return {}; }
    /// Position of the steering servo, 0 to 1, once it was told one.
    virtual std::optional<double> servo() const { return {}; }
    /// On its line, where it has one.
    virtual void setAddress(std::uint8_t) {}

    Faults &faults() { return faults_; }
    /// Begins or ends a fault by its name in sim.fault; amount: a share, or seconds. What happens once has no
    /// end. False: there is none of this name.
    bool setFault(const std::string &kind, double amount, bool on = true);
    MotorChannel &channel(int motor) { return channels_[std::size_t(motor)]; }
    const MotorChannel &channel(int motor) const { return channels_[std::size_t(motor)]; }
    const Counts &counts() const { return counts_; }

protected:
    /// The velocity control of each motor takes its full speed for full duty.
    explicit MotorEmulator(const Options &options);

    /// A byte that it can hear. It answers by send() or sendPlain().
    virtual void hear(std::uint8_t byte) = 0;
    /// Turns the motors, after the members that follow the time.
    virtual void turn(double seconds) = 0;
    /// Forgets what it was told since it was switched on.
    virtual void reset() = 0;

    bool isDead() const { return faults_.silent || startsIn_ > 0; }
    bool chance(double probability) {
        return probability > 0 && std::uniform_real_distribution<double>()(random_) < probability;
    }
    /// Answers with what the faults make of it, in pieces where it is long. late: seconds.
    void send(const std::uint8_t *data, std::size_t size, double late = 0);
    /// The same without checksums, byte for byte.
    void sendPlain(const std::string &text);
    /// A byte, either way, of a wire without checksums.
    std::uint8_t noisy(std::uint8_t byte) {
        return std::uint8_t(byte ^ (chance(faults_.corrupt) ? 1 << random_() % 8 : 0));
    }

    std::array<MotorChannel, 2> channels_;
    Faults faults_;
    Counts counts_;
    std::mt19937_64 random_;
    double silence_ = 0;  ///< seconds since what keeps it driving
    double startsIn_ = 0; ///< seconds
    double voltage_ = 24; ///< of the main battery

private:
    std::vector<Answer> answers_; ///< to the byte that it hears
};

} // namespace hermes::simulator
