#include "protocol/scan/SickCola.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace hermes::scan {
namespace {

constexpr std::int64_t stampPeriod32_ns = (std::int64_t(1) << 32) * 1000;
constexpr std::size_t maxTelegram = 65536;
constexpr std::uint32_t leastValue = 16; // less is a code
constexpr std::uint32_t manyLost = 1000; // the scanner was started anew
constexpr std::uint32_t longestScan_us = 10000000;
constexpr std::size_t firstOfEncoders = 19; // two words each

std::string framed(const char *text) {
    return '\x02' + std::string(text) + '\x03';
}

double floatOf(std::uint32_t bits) {
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

} // namespace

SickCola::SickCola(RevolutionAssembler &revolutions)
    : ScannerProtocol(revolutions)
    , clock_(stampPeriod32_ns, HostClock::Receiver::NeverJumps) {
    identity_.model = "SICK";
}

void SickCola::jump() {
    ScannerProtocol::jump();
    clock_ = HostClock(stampPeriod32_ns, HostClock::Receiver::NeverJumps);
    telegram_.reset();
}

/// It measures by itself. Only one that does not is started, which takes the rights of a client.
std::optional<ScannerProtocol::Request> SickCola::request(int step) const {
    static constexpr const char *texts[] = {"sEN LMDscandata 0", "sMN SetAccessMode 3 F4724744",
                                            "sMN LMCstartmeas", "sMN Run", "sEN LMDscandata 1"};
    if (step > Begin)
        return {};
    if (step != Stop && step != Begin && attempts() == 0)
        return Request();
    return Request{step < Begin ? Until::Silence : Until::Answer, framed(texts[step]), 1000};
}

std::size_t SickCola::take(std::string_view bytes, const Arrival &arrival) {
    if (bytes[0] != '\x02')
        return 0;
    if (bytes.substr(0, 4) == "\x02\x02\x02\x02")
        trouble_ = "the scanner speaks CoLa B (binary); it must be set to CoLa A";
    const std::size_t end = bytes.substr(0, maxTelegram).find_first_of("\x02\x03", 1);
    if (end == more)
        return bytes.size() < maxTelegram ? more : 0;
    if (bytes[end] == '\x02') { // the end of that before is missing
        counts_.skippedBytes += end;
        counts_.damaged += end > 1;
        return end;
    }
    words_.clear();
    for (std::size_t at = 1; at < end;) {
        const std::size_t space = std::min(bytes.find(' ', at), end);
        words_.push_back(bytes.substr(at, space - at));
        at = space + 1;
    }
    takeTelegram(arrival);
    return end + 1;
}

/// The number that a word is.
std::uint32_t SickCola::hex(std::size_t index) {
    std::uint32_t value = 0;
    if (index >= words_.size()) {
        isRight_ = false;
        return 0;
    }
    const char *const begin = words_[index].data(), *const end = begin + words_[index].size();
    const auto [behind, error] = std::from_chars(begin, end, value, 16);
    isRight_ = isRight_ && behind == end && error == std::errc();
    return value;
}

void SickCola::takeTelegram(const Arrival &arrival) {
    isRight_ = true;
    const auto begins = [this](std::string_view kind, std::string_view name) {
        return words_.size() > 1 && words_[0] == kind && words_[1] == name;
    };
    if (begins("sSN", "LMDscandata") || begins("sRA", "LMDscandata")) {
        counts_.damaged += !takeScan(arrival);
    } else if (begins("sEA", "LMDscandata")) {
        answered(Begin);
    } else if (words_.size() == 2 && words_[0] == "sFA") {
        const std::uint32_t error = hex(1);
        if (isRight_)
            problem_ = trouble_ = "the scanner refuses a request, error " + std::to_string(error);
    }
}

/// Reads channels of 16 bits, then those of 8.
void SickCola::takeChannels(std::size_t at, Channel &ranges, Channel &intensities) {
    for (const double unit : {1.0 / 256, 1.0}) { // of intensities
        for (std::uint32_t left = hex(at++); left > 0 && isRight_; --left) {
            Channel channel;
            channel.scale = floatOf(hex(at + 1));
            channel.offset = floatOf(hex(at + 2));
            channel.start_deg = std::int32_t(hex(at + 3)) * 1e-4;
            channel.step_deg = hex(at + 4) * 1e-4;
            channel.count = hex(at + 5);
            channel.first = at + 6;
            if (!isRight_ || channel.count > words_.size() - channel.first)
                return;
            if (words_[at] == "DIST1")
                ranges = channel;
            if (words_[at] == "RSSI1") {
                intensities = channel;
                intensities.scale *= unit;
            }
            at = channel.first + channel.count;
        }
    }
}

bool SickCola::isPossible(const Channel &channel) {
    return std::abs(channel.scale) < 1000 && std::abs(channel.offset) < 1e6 &&
           std::abs(channel.start_deg) <= 360 && channel.step_deg >= 0 &&
           channel.count * channel.step_deg <= 361;
}

/// Counter-clockwise, ahead is at 90 degrees. The stamp is of the head's zero index, which it passes at the
/// rear before the scan.
bool SickCola::takeScan(const Arrival &arrival) {
    const std::uint32_t state = hex(5) << 8 | hex(6), telegram = hex(7), stamp_us = hex(9), sent_us = hex(10);
    const double speed_hz = hex(16) * 0.01;
    Channel ranges, intensities;
    takeChannels(firstOfEncoders + std::size_t(2) * hex(18), ranges, intensities);
    const std::uint32_t late_us = sent_us - stamp_us;
    bool isSane = isRight_ && isPossible(ranges) && isPossible(intensities) && ranges.count > 0 &&
                  speed_hz > 0 && late_us < longestScan_us;
    for (std::size_t i = 0; isSane && i < ranges.count; ++i)
        isSane = hex(ranges.first + i) <= 0xFFFF && isRight_;
    if (!isSane)
        return false;
    if (words_[0] == "sSN")
        tellLost(telegram);
    const HostClock::Time time =
        clock_.take(std::int64_t(stamp_us) * 1000, arrival.mono_ns, std::int64_t(late_us) * 1000);
    revolutions_.setClockBound(time.bound_ns);
    for (std::size_t i = 0; i < ranges.count; ++i) {
        const std::uint32_t value = hex(ranges.first + i);
        const double range_mm = value < leastValue ? 0 : value * ranges.scale + ranges.offset;
        const double angle_deg = ranges.start_deg + double(i) * ranges.step_deg - 90;
        double intensity = 0;
        if (i < intensities.count)
            intensity = hex(intensities.first + i) * intensities.scale + intensities.offset;
        revolutions_.add({std::fmod(angle_deg + 720, 360), float(std::max(range_mm, 0.0) * 1e-3),
                          std::uint8_t(std::clamp(intensity, 0.0, 255.0)),
                          time.stamp_ns + std::int64_t((angle_deg + 180) / 360 / speed_hz * 1e9)});
    }
    revolutions_.endSweep();
    identity_.serial = std::to_string(hex(4));
    measured(arrival);
    if (state != 0)
        trouble_ = state == 2 || state == 5
                       ? "the scanner's window is dirty"
                       : "the scanner tells of a fault of its own, state " + std::to_string(state);
    return true;
}

void SickCola::tellLost(std::uint32_t telegram) {
    const std::uint32_t lost = telegram_ ? (telegram - *telegram_ - 1) & 0xFFFF : 0;
    if (lost > 0 && lost < manyLost) {
        revolutions_.lose(lost);
        revolutions_.endSweep(); // what follows is whole
    }
    telegram_ = telegram;
}

} // namespace hermes::scan
