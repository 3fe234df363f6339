#pragma once

#include "protocol/drive/ReplyReader.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

namespace hermes::drive {

/// Velocity control of a device; the same for every motor.
struct VelocityPid {
    double p = 1, i = 0.5, d = 0.25;
    int qpps = 150000; ///< counts/s at full duty

    bool operator==(const VelocityPid &o) const { return p == o.p && i == o.i && d == o.d && qpps == o.qpps; }
};

/// What a device is set up with; each takes what it can use.
struct DeviceSettings {
    VelocityPid pid;
    double timeout_s = 0.2;      ///< without a host, after which it shall stop by itself
    bool mayLackTimeout = false; ///< it is driven also when it would never stop by itself
    double brake_a = 5;     ///< with which a motor brakes that is told to stand, where a current does that
    double leastErpm = 900; ///< electrical turns a minute below which a motor would be released
    double countsPerTurn = 38000, wheelRadius_m = 0.1, halfTrack_m = 0.25; ///< of the wheels
};

/// The time-out of a device: it stops its motors by itself when its host is silent for so long.
struct DeviceTimeout {
    double seconds;      ///< after the set-up; infinite: it never does
    double atMost_s;     ///< before; 0: silence does not help
    bool isFixed;        ///< else it is written in the set-up, and its loss tells of a restart
    bool coasts = false; ///< then its motors are released; else they brake

    /// After so long without a host its motors stop, if ever.
    double silence_s() const { return std::isinf(seconds) ? atMost_s : seconds; }
};

/// What a device has told last. Beside the encoders, which are read in every cycle, there are slow readings,
/// one of which is read in a cycle.
struct Readings {
    std::array<std::uint32_t, 2> counts{}; ///< of the encoders of M1 and M2, modulo 2^32
    double countsTime = 0;                 ///< monotonic; 0: none since it was set up
    double battery_v = 0, logic_v = 0;
    std::array<double, 2> current_a{};           ///< of M1 and M2
    std::optional<std::array<double, 2>> duty{}; ///< of M1 and M2, -1 to 1; nothing: it does not tell
    double temperature_c = 0;
    std::uint32_t status = 0;             ///< bits of roboclaw::StatusBit
    std::array<const char *, 2> faults{}; ///< of M1 and M2, by other devices; nullptr: none
    bool complete = false; ///< each vital one of the slow ones has been read since it was set up
    int setups = 0;        ///< times it was set up: it may have been without power in between
    int restarts = 0;      ///< times that its counts told of one
};

/// What a device with two motors is told or asked.
struct Command {
    enum class Kind {
        SetSpeeds,  ///< zero: to stand, braking with the deceleration
        CutPower,   ///< of both motors, at once
        SetTimeout, ///< its own one
        ReadEncoders,
        ReadSlow, ///< one of the slow readings
        SetUp,    ///< a step of the set-up
    };
    Kind kind;
    int number = 0;                       ///< of the reading or the step, from 0
    std::array<std::int32_t, 2> speeds{}; ///< counts/s, of SetSpeeds
    std::uint32_t deceleration = 1;       ///< counts/s^2
    std::optional<double> servo{};        ///< position of its steering servo, 0 to 1; nothing: it has none

    bool isSetPoint() const { return kind == Kind::SetSpeeds || kind == Kind::CutPower; }
    /// What a set-point demands of a device whose power cannot be cut otherwise, counts/s.
    std::array<std::int32_t, 2> target() const {
        return kind == Kind::SetSpeeds ? speeds : std::array<std::int32_t, 2>{};
    }
};

/// What is said to one motor controller with two motors, and what it answers, byte for byte. Decides
/// nothing: what is asked when, and what follows from it, is the business of whoever drives it. Each command
/// is answered: where a device does not acknowledge, its driver asks something behind.
class MotorDevice {
public:
    /// For people; and what follows when it does not know the command, or answers nothing whole; or nothing.
    struct Name {
        std::string command, ifUnknown{}, ifSilent{};
    };

    virtual ~MotorDevice() = default;
    /// True when it has to be set up anew.
    virtual bool configure(const DeviceSettings &settings) = 0;
    virtual DeviceTimeout timeout() const = 0;
    virtual int setupSteps() const = 0;
    virtual int slowReadings() const = 0;
    /// Nothing is driven without an answer to it. The others tell of the battery only; the last reading is
    /// vital.
    virtual bool isVital(const Command &command) const = 0;

    /// The line was closed: what was sent before may lie in the device.
    virtual void forgetLine() {}

    virtual Bytes bytes(const Command &command) const = 0;
    virtual Name nameOf(const Command &command) const = 0;
    virtual ReplyReader &reader() = 0;
    /// Takes what the reader has read, after ReadSlow and SetUp. Gives what is wrong with it, or an empty
    /// text.
    virtual std::string take(const Command &command, Readings &readings) = 0;
    /// What the reader has read after ReadEncoders: modulo 2^32, also where the device counts in fewer bits.
    virtual std::array<std::uint32_t, 2> counts() const = 0;
    /// Latin-1; empty until it was told.
    virtual const std::string &version() const = 0;
};

/// One that reads its answers itself, and needs all of them.
class SelfReadingDevice : public MotorDevice, protected ReplyReader {
public:
    bool isVital(const Command &) const override { return true; }
    ReplyReader &reader() override { return *this; }
    const std::string &version() const override { return version_; }

protected:
    Result silence() override { return Result::Incomplete; }
    std::size_t received() const override { return received_; }

    std::string version_;
    std::size_t received_ = 0;
};

} // namespace hermes::drive
