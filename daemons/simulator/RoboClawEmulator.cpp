#include "daemons/simulator/RoboClawEmulator.h"

#include <cmath>

namespace hermes::simulator {

using namespace roboclaw;

namespace {

constexpr double longestGap = 0.010;          // seconds between the bytes of one packet
constexpr double eepromTime = 0.005;          // until a written cell is acknowledged; seconds
constexpr double warmth = 0.03, cooling = 60; // degrees for each A^2 at last, with this time constant (s)
constexpr double room = 25;                   // degrees Celsius
constexpr double hot = 85, tooHot = 100;      // data sheet: the current falls from 85 degrees, to none at 100

} // namespace

void RoboClawEmulator::Options::setFirmware(const std::string &number) {
    version = "RoboClaw 2x45A v" + number;
    status = number == "4.1.28" ? Dialect::Other : Dialect::Usual;
    dialect = number == "4.3.6" ? Dialect::Other : Dialect::Usual;
    unknown.clear();
    const auto forget = [this](int first, int last) {
        for (int command = first; command <= last; ++command)
            unknown.insert(Command(command));
    };
    if (number == "4.1.28") { // its manual does not list them
        forget(70, 72);
        forget(105, 107);
        forget(109, 118);
        forget(252, 253);
    }
    if (number == "4.3.6") { // no answer is reported to the first; the others have a new meaning
        forget(0, 13);
        forget(100, 107);
    }
}

std::vector<MotorEmulator::Answer> RoboClawEmulator::receive(std::uint8_t byte, double now) {
    if (now - lastByte_ > longestGap)
        parser_.silence();
    lastByte_ = now;
    return MotorEmulator::receive(byte, now);
}

void RoboClawEmulator::hear(std::uint8_t byte) {
    silence_ = 0;
    const RequestParser::Result result = parser_.feed(byte);
    counts_.crcErrors += result == RequestParser::Result::BadCrc;
    counts_.unknown += result == RequestParser::Result::Unknown;
    if (result != RequestParser::Result::Done)
        return;
    const Request &request = parser_.request();
    if (request.address != options_.address && !options_.anyAddress)
        return;
    const std::optional<Bytes> bytes = execute(request);
    if (!bytes)
        return;
    ++counts_.requests;
    send(bytes->data(), bytes->size());
    if (request.command == Command::WriteEeprom)
        send(&eepromWritten, 1, eepromTime);
}

void RoboClawEmulator::turn(double seconds) {
    const bool timedOut = timeoutTenths_ > 0 && !faults_.stuckTimeout && silence_ >= timeout();
    if (timedOut && silence_ - seconds < timeout())
        ++counts_.timeouts;
    const bool powered = !isDead() && !(statusBits() & MainVoltageLowError);
    double heat = 0;
    for (MotorChannel &channel : channels_) {
        if (timedOut || isStopped() || isDead())
            channel.stop();
        channel.advance(seconds, voltage_, powered);
        heat += channel.current() * channel.current() * warmth;
    }
    temperature_ += (room + heat - temperature_) * (1 - std::exp(-seconds / cooling));
}

void RoboClawEmulator::reset() {
    restoreDefaults();
    parser_.silence();
    mixedDrive_ = mixedTurn_ = std::nullopt;
}

bool RoboClawEmulator::isStopped() const {
    return statusBits() & (EmergencyStop | TemperatureError | DriverFaultM1 | DriverFaultM2);
}

std::uint32_t RoboClawEmulator::statusBits() const {
    const auto limits = readStored(Command::ReadMainLimits, {});
    std::uint32_t bits = faults_.status;
    const auto set = [&bits](bool on, StatusBit bit) { bits |= on ? std::uint32_t(bit) : 0; };
    set(voltage_ < double((*limits)[0]) / tenths, MainVoltageLowError);
    set(voltage_ > double((*limits)[1]) / tenths, MainVoltageHighError);
    set(temperature_ > hot, TemperatureWarning);
    set(temperature_ > tooHot, TemperatureError);
    set(channels_[0].isLimited(), OverCurrentWarningM1);
    set(channels_[1].isLimited(), OverCurrentWarningM2);
    return bits;
}

std::optional<Bytes> RoboClawEmulator::execute(const Request &request) {
    if (options_.unknown.count(request.command) > 0) {
        ++counts_.unknown;
        return {};
    }
    if (request.isRead())
        return answerTo(request);
    if (!(faults_.latched && turnsMotors(request.command))) {
        const bool drives = drive(request) || driveDistance(request) || drivePosition(request);
        if (drives)
            mixedDrive_ = mixedTurn_ = std::nullopt;
        if (!drives && !driveMixed(request) && !store(request))
            return {};
    }
    Bytes answer;
    answer.push(acknowledgement);
    return answer;
}

std::optional<Bytes> RoboClawEmulator::answerTo(const Request &request) {
    if (request.command == Command::ReadVersion)
        return encodeText(request, options_.version, options_.versionLineFeed);
    if (request.command == Command::ReadStatus) {
        const bool old = options_.status == Dialect::Other;
        return encodeReply(request, {old ? oldStatusOf(statusBits()) : statusBits()}, options_.status);
    }
    auto values = read(request.command);
    if (!values)
        values = readStored(request.command, request.values);
    return values ? encodeReply(request, *values, options_.dialect) : std::nullopt;
}

} // namespace hermes::simulator
