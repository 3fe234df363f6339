#include "daemons/simulator/ScannerEmulator.h"
#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hermes::simulator {

namespace {

struct Hokuyo {
    const char *name, *product;
    int steps; ///< a turn
    int firstStep, lastStep, front;
    const char *speedStatus; ///< answer to SS
};

const std::vector<Hokuyo> hokuyos{{"hokuyo-urg04lx", "SOKUIKI Sensor URG-04LX", 1024, 44, 725, 384, "00"},
                                  {"hokuyo-ust10lx", "UST-10LX", 1440, 0, 1080, 540, "0F"}};
constexpr int nearest_mm = 20;
constexpr int stepIntensity = 1000;
constexpr std::size_t lineLength = 64, longestRequest = 64;
constexpr std::int64_t clockSize_ms = 1 << 24;

/// Six bits a character.
std::string encoded(std::int64_t value, int characters) {
    std::string text;
    for (int i = characters - 1; i >= 0; --i)
        text.push_back(char((value >> 6 * i & 0x3F) + 0x30));
    return text;
}

/// Four decimal digits.
std::string digits(int step) {
    return std::to_string(10000 + step).substr(1);
}

char sumOf(std::string_view text) {
    unsigned sum = 0;
    for (const char byte : text)
        sum += std::uint8_t(byte);
    return char((sum & 0x3F) + 0x30);
}

std::string line(const std::string &text) {
    return text + sumOf(text) + '\n';
}

/// Of VV, PP and II: the sum is that of what stands before the semicolon.
std::string property(const char *name, const std::string &value) {
    const std::string text = name + (':' + value);
    return text + ';' + sumOf(text) + '\n';
}

/// SCIP 2: a device that is asked, and whose head turns counter-clockwise.
class HokuyoEmulator : public ScannerEmulator {
public:
    HokuyoEmulator(const ScannerModel &model, const ScannerOptions &options)
        : ScannerEmulator(model, options)
        , type_(typeOf(model, hokuyos)) {}

protected:
    void hear(std::uint8_t byte, std::int64_t now_ns) override;
    bool isScanning() const override { return !scan_.echo.empty() && turns(); }
    void sample(std::int64_t time_ns, const Measure &measure) override;
    void resume() override { measureAs("MD" + digits(type_.firstStep) + digits(type_.lastStep) + "01000"); }

private:
    /// What was asked for.
    struct Scan {
        std::string echo; ///< empty: nothing
        int first = 0, last = 0, cluster = 1, skip = 0, count = 0;
        bool intensity = false;
        bool once = false;
    };

    void obey(const std::string &request);
    std::string measureAs(const std::string &request);
    std::string stamp(std::int64_t time_ns) const {
        return line(encoded(clock_ms(time_ns) % clockSize_ms, 4));
    }
    std::string version() const;
    std::string parameters() const;
    std::string state() const;
    void sendScan(std::int64_t time_ns);

    const Hokuyo &type_;
    std::string request_;
    std::int64_t now_ns_ = 0;
    bool laser_ = false, timeMode_ = false, reboots_ = false;
    Scan scan_;
    int turns_ = 0;      ///< begun since a scan was sent
    bool begun_ = false; ///< this one is told
    std::string stamp_, values_;
    int least_ = 0, inCluster_ = 0;
};

void HokuyoEmulator::hear(std::uint8_t byte, std::int64_t now_ns) {
    now_ns_ = now_ns;
    if (byte != '\n' && byte != '\r') {
        if (request_.size() < longestRequest)
            request_.push_back(char(byte));
        return;
    }
    if (!request_.empty())
        obey(request_);
    request_.clear();
}

void HokuyoEmulator::obey(const std::string &request) {
    const std::string command = request.substr(0, 2);
    const bool again = std::exchange(reboots_, command == "RB");
    std::string status = "00", lines;
    if (command == "QT" || command == "RS" || (command == "RB" && again)) {
        scan_ = {};
        laser_ = false;
        timeMode_ = timeMode_ && command == "QT";
    } else if (command == "VV") {
        lines = version();
    } else if (command == "PP") {
        lines = parameters();
    } else if (command == "II") {
        lines = state();
    } else if (request == "TM0") {
        timeMode_ = scan_.echo.empty();
        status = timeMode_ ? "00" : "0A";
    } else if (request == "TM1" && timeMode_) {
        lines = stamp(now_ns_);
    } else if (request == "TM2") {
        timeMode_ = false;
    } else if (command == "SS") {
        status = type_.speedStatus;
    } else if (command != "RB" && request != "SCIP2.0") {
        if (timeMode_) {
            status = "0E";
        } else if (command == "BM") {
            status = std::exchange(laser_, true) ? "02" : "00";
        } else {
            const bool known = command == "MD" || command == "ME" || command == "GD";
            status = known ? measureAs(request) : "0A";
        }
    }
    if (command != "GD" || status != "00") // that answers with its scan
        send(request + '\n' + line(status) + lines + '\n', now_ns_);
}

/// Gives the status.
std::string HokuyoEmulator::measureAs(const std::string &request) {
    const bool once = request[0] == 'G';
    const std::string given = request.substr(2, request.find(';') - 2);
    if (given.size() < (once ? 10 : 13) || given.find_first_not_of("0123456789") != given.npos)
        return "01";
    const auto number = [&](std::size_t at, std::size_t size) { return std::stoi(given.substr(at, size)); };
    Scan scan{request, number(0, 4), number(4, 4), std::max(1, number(8, 2)), 0, 1, request[1] == 'E', once};
    if (scan.last > type_.lastStep || scan.first > scan.last)
        return scan.last > type_.lastStep ? "02" : "04";
    if (once && !laser_)
        return "0A";
    if (!once) {
        scan.skip = number(10, 1);
        scan.count = number(11, 2);
    }
    laser_ = true;
    scan_ = scan;
    begun_ = false;
    turns_ = scan.skip;
    return "00";
}

void HokuyoEmulator::sample(std::int64_t time_ns, const Measure &measure) {
    // It begins at the rear, where a scan's time is taken.
    const int passed = int(std::lround(turn() * type_.steps)) % type_.steps;
    const int step = passed + type_.front - type_.steps / 2;
    if (passed == 0) {
        begun_ = ++turns_ > scan_.skip;
        stamp_ = stamp(time_ns);
        values_.clear();
        inCluster_ = 0;
    }
    if (!begun_ || step < scan_.first || step > scan_.last)
        return;
    const bool seen = step >= type_.firstStep;
    const int mm = seen ? range_mm(measure, 2 * vectorlib::pi * (step - type_.front) / type_.steps) : 0;
    const int told = mm >= nearest_mm ? mm : 0; // what is less is a code
    least_ = inCluster_ == 0 ? told : std::min(least_, told);
    if (++inCluster_ == scan_.cluster || step == scan_.last) {
        inCluster_ = 0;
        values_ += encoded(least_, 3);
        if (scan_.intensity)
            values_ += encoded(least_ > 0 ? stepIntensity : 0, 3);
    }
    if (step == scan_.last)
        sendScan(time_ns);
}

void HokuyoEmulator::sendScan(std::int64_t time_ns) {
    const bool last = scan_.count == 1;
    if (!scan_.once && scan_.count > 0) {
        --scan_.count;
        scan_.echo[13] = char('0' + scan_.count / 10);
        scan_.echo[14] = char('0' + scan_.count % 10);
    }
    std::string text = scan_.echo + '\n' + line(scan_.once ? "00" : "99") + stamp_;
    for (std::size_t at = 0; at < values_.size(); at += lineLength)
        text += line(values_.substr(at, lineLength));
    send(text + '\n', time_ns);
    turns_ = 0;
    begun_ = false;
    if (last)
        scan_ = {};
}

std::string HokuyoEmulator::version() const {
    return property("VEND", "Hokuyo Automatic Co.,Ltd.") + property("PROD", type_.product) +
           property("FIRM", "3.3.00") + property("PROT", "SCIP 2.0") + property("SERI", "H0000001");
}

std::string HokuyoEmulator::parameters() const {
    const auto number = [](const char *name, int value) { return property(name, std::to_string(value)); };
    return property("MODL", type_.product) + number("DMIN", nearest_mm) +
           number("DMAX", int(std::lround(model().range_m * 1000))) + number("ARES", type_.steps) +
           number("AMIN", type_.firstStep) + number("AMAX", type_.lastStep) + number("AFRT", type_.front) +
           number("SCAN", int(std::lround(model().turns_hz * 60)));
}

std::string HokuyoEmulator::state() const {
    return property("MODL", type_.product) + property("LASR", laser_ ? "ON" : "OFF") +
           property("SCSP", std::to_string(std::lround(model().turns_hz * 60))) +
           property("MESM", scan_.echo.empty() ? "IDLE" : "Measuring") +
           property("TIME", encoded(clock_ms(now_ns_) % clockSize_ms, 4)) +
           property("STAT", "Sensor works well.");
}

} // namespace

std::unique_ptr<ScannerEmulator> makeHokuyo(const ScannerModel &model, const ScannerOptions &options) {
    return std::make_unique<HokuyoEmulator>(model, options);
}

} // namespace hermes::simulator
