#pragma once

#include "daemons/simulator/MotorChannel.h"
#include "protocol/roboclaw/Packet.h"
#include "protocol/roboclaw/Status.h"

#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace hermes::simulator {

/// A RoboClaw with two motors as it looks from its serial line: bytes in, answers out. It is silent
/// when a command is unknown. Knows no line and no clock.
class RoboClawEmulator {
public:
    struct Options {
        std::uint8_t address = roboclaw::firstAddress;
        bool anyAddress = false; ///< as on USB, where each of 0x80 to 0x87 is answered
        std::string version = "RoboClaw 2x45A v4.2.8";
        bool versionLineFeed = true;                          ///< the version's text ends with one
        roboclaw::Dialect status = roboclaw::Dialect::Usual;  ///< Other: status of 16 bits
        roboclaw::Dialect dialect = roboclaw::Dialect::Usual; ///< of all other commands; Other: as of 4.3
        std::set<roboclaw::Command> unknown;                  ///< commands that the firmware does not know
        MotorChannel::Motor motor;
        std::uint64_t seed = 1; ///< of the faults

        /// Version, status, dialect and unknown commands of one of firmwareVersions.
        void setFirmware(const std::string &number);
    };
    static constexpr std::array<const char *, 3> firmwareVersions{"4.1.28", "4.2.8", "4.3.6"};

    /// What it does wrong.
    struct Faults {
        bool silent = false;       ///< dead: hears nothing, does nothing, motors off
        bool deaf = false;         ///< hears nothing; drives on until its own time-out
        bool latched = false;      ///< acknowledges new set-points, but keeps the last one
        bool stuckTimeout = false; ///< its own time-out does not work
        bool echo = false;         ///< what it receives comes back before its answers
        double drop = 0;           ///< share of the answers that are not sent; 1: mute
        double corrupt = 0;        ///< share of the answers with one bit flipped
        double delay = 0;          ///< seconds by which each answer is late
        std::uint32_t status = 0;  ///< bits that are set besides its own; EmergencyStop stops it too
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
    explicit RoboClawEmulator(const Options &options)
        : options_(options)
        , parser_(options.dialect)
        , channels_{MotorChannel(options.motor), MotorChannel(options.motor)}
        , random_(options.seed) {}

    /// One byte from the line, now: seconds of any clock, to know the gaps between bytes.
    std::vector<Answer> receive(std::uint8_t byte, double now);
    /// Lets time pass. voltage: of the main battery; ambient: degrees Celsius.
    void advance(double seconds, double voltage, double ambient = 25);

    /// As after a brown-out: for so many seconds it is dead, then it answers with the settings of the factory
    /// and counts of 0. What WriteEeprom wrote stays.
    void restart(double seconds);

    Faults &faults() { return faults_; }
    std::uint8_t address() const { return options_.address; }
    void setAddress(std::uint8_t address) { options_.address = address; }
    MotorChannel &channel(int motor) { return channels_[std::size_t(motor)]; }
    const MotorChannel &channel(int motor) const { return channels_[std::size_t(motor)]; }
    std::uint32_t status() const;
    double temperature() const { return temperature_; }
    double serialTimeout() const { return timeoutTenths_ * 0.1; }
    const Counts &counts() const { return counts_; }

private:
    static constexpr double fullDuty = 32767;
    static constexpr double tenths = 10; // of a volt, of a degree
    using Request = roboclaw::Request;
    using Command = roboclaw::Command;

    std::optional<roboclaw::Bytes> execute(const Request &request);
    std::optional<roboclaw::Bytes> answerTo(const Request &request);
    static bool turnsMotors(Command command);
    bool drive(const Request &request);
    bool driveDistance(const Request &request);
    bool drivePosition(const Request &request);
    /// A drive and a turn value must have come before the motors turn.
    bool driveMixed(const Request &request);
    bool store(const Request &request);
    void setLimit(Command write, Command read, std::size_t index, double volts);
    void restoreDefaults();
    std::optional<roboclaw::Values> read(Command command);
    std::optional<roboclaw::Values> readStored(Command command, const roboclaw::Values &asked) const;
    std::optional<Answer> damaged(const roboclaw::Bytes &bytes);
    bool isStopped() const;
    bool isDead() const { return faults_.silent || startsIn_ > 0; }
    bool chance(double probability) {
        return probability > 0 && std::uniform_real_distribution<double>()(random_) < probability;
    }

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
    double startsIn_ = 0;   ///< seconds
    double voltage_ = 24;
    double temperature_ = 25;
};

} // namespace hermes::simulator
