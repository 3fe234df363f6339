#pragma once

#include "daemons/simulator/MotorChannel.h"
#include "protocol/roboclaw/RequestParser.h"
#include "protocol/roboclaw/Status.h"

#include <map>
#include <optional>
#include <random>
#include <string>

namespace hermes {

/// A RoboClaw with two motors as it looks from its serial line: bytes in, answers out. It is silent
/// when a command is unknown. Knows no line and no clock.
class RoboClawEmulator {
public:
    struct Options {
        std::uint8_t address = roboclaw::firstAddress;
        bool anyAddress = false; ///< as on USB, where each of 0x80 to 0x87 is answered
        std::string version = "RoboClaw 2x45A v4.2.8";
        roboclaw::Dialect status = roboclaw::Dialect::Usual; ///< Other: status of 16 bits
        MotorChannel::Motor motor;
        std::uint64_t seed = 1; ///< of the faults
    };
    /// What it does wrong.
    struct Faults {
        bool silent = false;      ///< dead: hears nothing, does nothing, motors off
        double drop = 0;          ///< share of the answers that are not sent
        double corrupt = 0;       ///< share of the answers with one bit flipped
        double delay = 0;         ///< seconds by which each answer is late
        std::uint32_t status = 0; ///< bits that are set besides its own; EmergencyStop stops it too
    };
    struct Answer {
        roboclaw::Bytes bytes;
        double delay = 0; ///< seconds
    };
    struct Counts {
        std::uint64_t requests = 0; ///< carried out
        std::uint64_t crcErrors = 0;
        std::uint64_t unknown = 0;
        std::uint64_t timeouts = 0; ///< times that silence stopped the motors
    };

    RoboClawEmulator()
        : RoboClawEmulator(Options()) {}
    explicit RoboClawEmulator(const Options &options);

    /// One byte from the line, now: seconds of any clock, to know the gaps between bytes.
    std::optional<Answer> receive(std::uint8_t byte, double now);
    /// Lets time pass. voltage: of the main battery; ambient: degrees Celsius.
    void advance(double seconds, double voltage, double ambient = 25);

    Faults &faults() { return faults_; }
    MotorChannel &channel(int motor) { return channels_[std::size_t(motor)]; }
    const MotorChannel &channel(int motor) const { return channels_[std::size_t(motor)]; }
    std::uint32_t status() const;
    double temperature() const { return temperature_; }
    double serialTimeout() const { return timeoutTenths_ * 0.1; }
    const Counts &counts() const { return counts_; }

private:
    using Request = roboclaw::Request;
    using Command = roboclaw::Command;

    std::optional<roboclaw::Bytes> execute(const Request &request);
    bool drive(const Request &request);
    bool driveDistance(const Request &request);
    bool drivePosition(const Request &request);
    /// A drive and a turn value must have come before the motors turn.
    bool driveMixed(const Request &request);
    bool store(const Request &request);
    std::optional<roboclaw::Values> read(Command command);
    std::optional<roboclaw::Values> readStored(Command command, const roboclaw::Values &asked) const;
    std::optional<Answer> damaged(const roboclaw::Bytes &bytes);
    bool isStopped() const;
    bool chance(double probability);

    Options options_;
    roboclaw::RequestParser parser_;
    std::array<MotorChannel, 2> channels_;
    std::optional<double> mixedDrive_, mixedTurn_;     ///< -1 to 1
    std::map<std::uint32_t, roboclaw::Values> stored_; ///< by command, for the EEPROM by command and address
    Faults faults_;
    Counts counts_;
    std::mt19937_64 random_;
    double lastByte_ = 0;
    double silence_ = 0;
    int timeoutTenths_ = 0; ///< 0: none
    double voltage_ = 24;
    double temperature_ = 25;
};

} // namespace hermes
