#include "daemons/simulator/RoboClawEmulator.h"

#include <algorithm>
#include <cmath>

namespace hermes::simulator {

using namespace roboclaw;

namespace {

constexpr double longestGap = 0.010;          // seconds between the bytes of one packet
constexpr double eepromTime = 0.005;          // until a written cell is acknowledged; seconds
constexpr double warmth = 0.03, cooling = 60; // degrees for each A^2 at last, with this time constant (s)
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

std::vector<RoboClawEmulator::Answer> RoboClawEmulator::receive(std::uint8_t byte, double now) {
    if (now - lastByte_ > longestGap)
        parser_.silence();
    lastByte_ = now;
    std::vector<Answer> answers;
    if (faults_.echo) {
        answers.emplace_back();
        answers.back().bytes.push(byte);
    }
    if (isDead() || faults_.deaf)
        return answers;
    silence_ = 0;
    const RequestParser::Result result = parser_.feed(byte);
    counts_.crcErrors += result == RequestParser::Result::BadCrc;
    counts_.unknown += result == RequestParser::Result::Unknown;
    if (result != RequestParser::Result::Done)
        return answers;
    const Request &request = parser_.request();
    if (request.address != options_.address && !options_.anyAddress)
        return answers;
    const std::optional<Bytes> bytes = execute(request);
    if (!bytes)
        return answers;
    ++counts_.requests;
    if (const auto answer = damaged(*bytes))
        answers.push_back(*answer);
    if (request.command == Command::WriteEeprom) {
        Bytes written;
        written.push(eepromWritten);
        if (auto answer = damaged(written)) {
            answer->delay += eepromTime;
            answers.push_back(*answer);
        }
    }
    return answers;
}

std::optional<RoboClawEmulator::Answer> RoboClawEmulator::damaged(const Bytes &bytes) {
    if (chance(faults_.drop))
        return {};
    if (!chance(faults_.corrupt))
        return Answer{bytes, faults_.delay};
    const std::size_t bit = random_() % (bytes.size() * 8);
    Answer answer{{}, faults_.delay};
    for (std::size_t i = 0; i < bytes.size(); ++i)
        answer.bytes.push(std::uint8_t(bytes[i] ^ (bit / 8 == i ? 1 << bit % 8 : 0)));
    return answer;
}

void RoboClawEmulator::advance(double seconds, double voltage, double ambient) {
    voltage_ = voltage;
    silence_ += seconds;
    startsIn_ = std::max(0.0, startsIn_ - seconds);
    const bool timedOut = timeoutTenths_ > 0 && !faults_.stuckTimeout && silence_ >= serialTimeout();
    if (timedOut && silence_ - seconds < serialTimeout())
        ++counts_.timeouts;
    const bool powered = !isDead() && !(status() & MainVoltageLowError);
    double heat = 0;
    for (MotorChannel &channel : channels_) {
        if (timedOut || isStopped() || isDead())
            channel.stop();
        channel.advance(seconds, voltage, powered);
        heat += channel.current() * channel.current() * warmth;
    }
    temperature_ += (ambient + heat - temperature_) * (1 - std::exp(-seconds / cooling));
}

void RoboClawEmulator::restart(double seconds) {
    restoreDefaults();
    parser_.silence();
    mixedDrive_ = mixedTurn_ = std::nullopt;
    for (MotorChannel &channel : channels_) {
        channel.stop();
        channel.setCount(0);
    }
    startsIn_ = seconds;
}

bool RoboClawEmulator::isStopped() const {
    return status() & (EmergencyStop | TemperatureError | DriverFaultM1 | DriverFaultM2);
}

std::uint32_t RoboClawEmulator::status() const {
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
        return encodeReply(request, {old ? oldStatusOf(status()) : status()}, options_.status);
    }
    auto values = read(request.command);
    if (!values)
        values = readStored(request.command, request.values);
    return values ? encodeReply(request, *values, options_.dialect) : std::nullopt;
}

} // namespace hermes::simulator
