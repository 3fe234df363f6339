#pragma once

#include "daemons/simulator/MotorEmulator.h"
#include "protocol/roboclaw/Packet.h"
#include "protocol/roboclaw/Status.h"

#include <map>
#include <set>

namespace hermes::simulator {

/// A RoboClaw with two motors. It is silent when a command is unknown.
class RoboClawEmulator : public MotorEmulator {
public:
    struct Options : MotorEmulator::Options {
        std::uint8_t address = roboclaw::firstAddress;
        bool anyAddress = false; ///< as on USB, where each of 0x80 to 0x87 is answered
        std::string version = "RoboClaw 2x45A v4.2.8";
        bool versionLineFeed = true;                          ///< the version's text ends with one
        roboclaw::Dialect status = roboclaw::Dialect::Usual;  ///< Other: status of 16 bits
        roboclaw::Dialect dialect = roboclaw::Dialect::Usual; ///< of all other commands; Other: as of 4.3
        std::set<roboclaw::Command> unknown;                  ///< commands that the firmware does not know

        /// Version, status, dialect and unknown commands of one of firmwareVersions.
        void setFirmware(const std::string &number);
    };
    static constexpr std::array<const char *, 3> firmwareVersions{"4.1.28", "4.2.8", "4.3.6"};

    RoboClawEmulator()
        : RoboClawEmulator(Options()) {}
    explicit RoboClawEmulator(const Options &options)
        : MotorEmulator(options)
        , options_(options)
        , parser_(options.dialect) {
        restoreDefaults();
    }

    std::vector<Answer> receive(std::uint8_t byte, double now) override;
    double timeout() const override { return timeoutTenths_ * 0.1; }
    std::optional<std::uint32_t> status() const override { return statusBits(); }
    std::optional<double> temperature() const override { return temperature_; }
    void setAddress(std::uint8_t address) override { options_.address = address; }

private:
    static constexpr double fullDuty = 32767;
    static constexpr double tenths = 10; // of a volt, of a degree
    using Request = roboclaw::Request;
    using Command = roboclaw::Command;

    void hear(std::uint8_t byte) override;
    void turn(double seconds) override;
    /// To the settings of the factory. What WriteEeprom wrote stays.
    void reset() override;
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
    std::uint32_t statusBits() const;
    bool isStopped() const;

    Options options_;
    roboclaw::RequestParser parser_;
    std::optional<double> mixedDrive_, mixedTurn_;     ///< -1 to 1
    std::map<std::uint32_t, roboclaw::Values> stored_; ///< by command, for the EEPROM by command and address
    double lastByte_ = 0;
    int timeoutTenths_ = 0; ///< 0: none
    double temperature_ = 25;
};

} // namespace hermes::simulator
