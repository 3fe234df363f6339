#include "protocol/scan/Hokuyo.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

namespace hermes::scan {
namespace {

constexpr std::int64_t stampPeriod24_ns = (std::int64_t(1) << 24) * 1000000;
constexpr std::int64_t longGap_ns = 10000000000; // the scanner may have been started anew
constexpr std::size_t maxBlock = 16384;
constexpr std::size_t echoSize = 15;   // of a scan: MD, first, last, cluster, skipped, count
constexpr std::size_t dataOfLine = 64; // but of the last
constexpr int leastRange_mm = 20;      // less is a code

/// The last character is the sum of those before, or of all but a semicolon before it.
bool isSummed(std::string_view line, bool hasSemicolon = false) {
    const std::size_t behind = hasSemicolon ? 2 : 1;
    if (line.size() <= behind || (hasSemicolon && line[line.size() - 2] != ';'))
        return false;
    unsigned sum = 0;
    for (const char character : line.substr(0, line.size() - behind))
        sum += std::uint8_t(character);
    return line.back() == char((sum & 0x3F) + 0x30);
}

/// The sum has six bits, as has a character: those that it does not know are the same in all.
bool isData(std::string_view line) {
    return isSummed(line) &&
           std::all_of(line.begin(), line.end(), [](char c) { return c >= 0x30 && c < 0x70; });
}

bool isText(std::string_view line) {
    return std::all_of(line.begin(), line.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

int valueOf(std::string_view characters) {
    int value = 0;
    for (const char character : characters)
        value = value << 6 | (character - 0x30);
    return value;
}

/// -1: anything else stands there, too.
int decimal(std::string_view digits) {
    int value = 0;
    const auto end = std::from_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    return end == digits.data() + digits.size() ? value : -1;
}

/// Takes the first line off; it returns it without its end.
std::string_view cutLine(std::string_view &text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return line;
}

} // namespace

Hokuyo::Hokuyo(RevolutionAssembler &revolutions)
    : ScannerProtocol(revolutions)
    , clock_(stampPeriod24_ns, HostClock::Receiver::NeverJumps) {
    identity_.model = "Hokuyo";
}

void Hokuyo::jump() {
    ScannerProtocol::jump();
    clock_ = HostClock(stampPeriod24_ns, HostClock::Receiver::NeverJumps);
    lastStamp_ns_.reset();
}

bool Hokuyo::isPossible(const Sweep &sweep) {
    return sweep.around > 0 && sweep.around <= 100000 && sweep.first >= 0 && sweep.first <= sweep.last &&
           sweep.last < 10000 && sweep.ahead >= 0 && sweep.ahead <= sweep.around && sweep.speed_rpm > 0;
}

std::string Hokuyo::prerequisite() const {
    char text[80];
    std::snprintf(text, sizeof text, "%d %d %d %d %d", sweep_.around, sweep_.first, sweep_.last, sweep_.ahead,
                  sweep_.speed_rpm);
    return isPossible(sweep_) ? text : std::string();
}

void Hokuyo::prepare(const std::string &prerequisite) {
    Sweep sweep;
    if (std::sscanf(prerequisite.c_str(), "%d %d %d %d %d", &sweep.around, &sweep.first, &sweep.last,
                    &sweep.ahead, &sweep.speed_rpm) == 5 &&
        isPossible(sweep))
        sweep_ = sweep;
}

std::optional<ScannerProtocol::Request> Hokuyo::request(int step) const {
    static constexpr const char *commands[] = {"QT\n", "SCIP2.0\n", "TM2\n", "VV\n", "PP\n", "BM\n"};
    if (step > Begin)
        return {};
    if ((step == Scip && !isFirstScip_) || (step == Clock && !isClockMode_))
        return Request();
    char scan[24]; // all steps, one by one, each scan, without end
    std::snprintf(scan, sizeof scan, "MD%04d%04d01000\n", sweep_.first, sweep_.last);
    return Request{step < Version ? Until::Silence : Until::Answer, step < Begin ? commands[step] : scan,
                   step == Version ? 300 : 500};
}

std::size_t Hokuyo::take(std::string_view bytes, const Arrival &arrival) {
    if (bytes[0] == '\n')
        return 1;
    const std::size_t end = bytes.substr(0, maxBlock).find("\n\n");
    if (end == more) {
        if (bytes.size() < maxBlock)
            return more;
        counts_.skippedBytes += maxBlock;
        isBroken_ = true;
        return maxBlock;
    }
    std::string_view block = bytes.substr(0, end);
    const std::size_t scan = block.rfind("\n99b\n");
    const bool isScan = scan != more && scan >= echoSize && block.substr(scan - echoSize, 2) == "MD";
    if (isScan && scan > echoSize) { // the end of the block before is damaged
        block.remove_prefix(scan - echoSize);
        isBroken_ = true;
    }
    if (!(isScan ? takeScan(block, arrival) : takeBlock(block))) {
        counts_.skippedBytes += end + 2;
        isBroken_ = true;
    }
    return end + 2;
}

bool Hokuyo::takeBlock(std::string_view block) {
    const std::string_view command = cutLine(block), status = cutLine(block);
    if (status == "E") {
        isFirstScip_ = command == "QT";
        return true;
    }
    if (!isText(command) || status.size() != 3 || !isData(status) || status == "99b")
        return false;
    takeStatus(command, status.substr(0, 2));
    if (command == "VV" || command == "PP")
        takeFacts(block);
    return true;
}

void Hokuyo::takeFacts(std::string_view lines) {
    static constexpr std::pair<std::string_view, std::string ScannerIdentity::*> texts[] = {
        {"PROD", &ScannerIdentity::model},
        {"FIRM", &ScannerIdentity::firmware},
        {"SERI", &ScannerIdentity::serial}};
    static constexpr std::pair<std::string_view, int Sweep::*> numbers[] = {{"ARES", &Sweep::around},
                                                                            {"AMIN", &Sweep::first},
                                                                            {"AMAX", &Sweep::last},
                                                                            {"AFRT", &Sweep::ahead},
                                                                            {"SCAN", &Sweep::speed_rpm}};
    Sweep sweep;
    while (!lines.empty()) {
        const std::string_view line = cutLine(lines);
        if (line.size() < 7 || line[4] != ':' || !isText(line) || !isSummed(line, true)) {
            ++counts_.damaged;
            continue;
        }
        const std::string_view name = line.substr(0, 4), value = line.substr(5, line.size() - 7);
        for (const auto &[known, text] : texts)
            if (name == known)
                identity_.*text = value;
        for (const auto &[known, number] : numbers)
            if (name == known)
                sweep.*number = decimal(value);
    }
    if (isPossible(sweep)) {
        sweep_ = sweep;
        answered(Parameters);
    } else {
        answered(Version);
    }
}

void Hokuyo::takeStatus(std::string_view command, std::string_view status) {
    const bool isGood = status == "00" || status == "98" || (command == "BM" && status == "02");
    if (isGood) {
        if (command == "QT")
            isFirstScip_ = isClockMode_ = false;
        if (command == "BM")
            answered(Laser);
        if (command.substr(0, 2) == "MD")
            answered(Begin);
        return;
    }
    if (command == "QT") {
        isClockMode_ = status == "0E";
        return;
    }
    const char *const what = status[0] < '2'   ? "refuses a command"
                             : status[0] < '5' ? "checks itself"
                                               : "tells of a fault of its hardware";
    trouble_ = std::string("the scanner ") + what + ": " + std::string(command.substr(0, 16)) + ", status " +
               std::string(status);
    problem_ = trouble_;
}

/// Damage may make one block of two, or two of one: the scanner's clock tells how many scans are missing.
void Hokuyo::tellLost(std::int64_t stamp_ns, double period_ns) {
    if (isBroken_ && lastStamp_ns_) {
        const std::int64_t passed_ns = (stamp_ns - *lastStamp_ns_ + stampPeriod24_ns) % stampPeriod24_ns;
        const double missing = passed_ns < longGap_ns ? std::round(double(passed_ns) / period_ns) - 1 : 0;
        const auto lost = std::uint64_t(std::max(missing, 1.0));
        counts_.damaged += lost;
        revolutions_.lose(lost);
        revolutions_.endSweep(); // what follows is whole
    }
    isBroken_ = false;
    lastStamp_ns_ = stamp_ns;
}

/// The stamp is of step 0, at the rear, where the head is before it comes to the first beam.
bool Hokuyo::takeScan(std::string_view block, const Arrival &arrival) {
    const std::string_view echo = cutLine(block);
    cutLine(block); // 99b
    const std::string_view stamp = cutLine(block);
    const int first = decimal(echo.substr(2, 4)), last = decimal(echo.substr(6, 4));
    const int cluster = decimal(echo.substr(10, 2));
    if (!isPossible(sweep_) || stamp.size() != 5 || !isData(stamp) || first < sweep_.first || first > last ||
        last > sweep_.last || cluster > 1)
        return false;
    values_.clear();
    while (!block.empty()) {
        const std::string_view line = cutLine(block);
        if (!isData(line) || line.size() > dataOfLine + 1 || (line.size() < dataOfLine + 1 && !block.empty()))
            return false;
        values_ += line.substr(0, line.size() - 1);
    }
    if (values_.size() != std::size_t(last - first + 1) * 3)
        return false;
    const double step_deg = 360.0 / sweep_.around, period_ns = 60e9 / sweep_.speed_rpm;
    const auto afterRear_ns = [&](int step) {
        return std::int64_t(((step - sweep_.ahead) * step_deg + 180) / 360 * period_ns);
    };
    // How long the line takes is not known: its rate is that of no line where it is USB.
    const std::int64_t stamp_ns = valueOf(stamp.substr(0, 4)) * std::int64_t(1000000);
    tellLost(stamp_ns, period_ns);
    const HostClock::Time time = clock_.take(stamp_ns, arrival.mono_ns, afterRear_ns(last));
    revolutions_.setClockBound(time.bound_ns + 1000000);
    for (int step = first; step <= last; ++step) {
        const int range_mm = valueOf(std::string_view(values_).substr(std::size_t(step - first) * 3, 3));
        const double angle_deg = std::fmod((step - sweep_.ahead) * step_deg + 720, 360);
        revolutions_.add({angle_deg, range_mm < leastRange_mm ? 0 : float(range_mm) * 1e-3F, 0,
                          time.stamp_ns + afterRear_ns(step)});
    }
    revolutions_.endSweep();
    measured(arrival);
    return true;
}

} // namespace hermes::scan
