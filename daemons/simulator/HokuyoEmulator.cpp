#include "daemons/simulator/SectorScanner.h"

#include <utility>

namespace hermes::simulator {

namespace {

struct Hokuyo {
    const char *name, *product;
    int firstStep, lastStep, front;
    const char *speedStatus; ///< answer to SS
};

const std::vector<Hokuyo> hokuyos{{"hokuyo-urg04lx", "SOKUIKI Sensor URG-04LX", 44, 725, 384, "00"},
                                  {"hokuyo-ust10lx", "UST-10LX", 0, 1080, 540, "0F"}};
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

std::string clock(std::int64_t us) {
    return encoded(us / 1000 % clockSize_ms, 4);
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
std::string properties(const std::vector<std::string> &texts) {
    std::string lines;
    for (const std::string &text : texts)
        lines += text + ';' + sumOf(text) + '\n';
    return lines;
}

/// SCIP 2: a device that is asked.
class HokuyoEmulator : public SectorScanner {
public:
    HokuyoEmulator(const ScannerModel &model, const ScannerOptions &options)
        : SectorScanner(model, options)
        , type_(typeOf(model, hokuyos)) {
        setSector(fromRear(type_.firstStep), fromRear(type_.lastStep));
    }

protected:
    void hear(std::uint8_t byte) override;
    bool isScanning() const override { return !scan_.echo.empty() && turns(); }
    void pass(int step) override;
    void resume() override { measureAs("MD" + digits(type_.firstStep) + digits(type_.lastStep) + "01000"); }
    void hangUp() override { scan_ = {}; }

private:
    /// What was asked for.
    struct Scan {
        std::string echo; ///< empty: nothing
        int first = 0, last = 0, cluster = 1, skip = 0, count = 0;
        bool isOnce() const { return echo[0] == 'G'; }
    };

    void obey(const std::string &request);
    std::string measureAs(const std::string &request);
    int fromRear(int step) const { return step - type_.front + steps() / 2; }
    std::string tell(const std::string &command) const;

    const Hokuyo &type_;
    bool laser_ = false, timeMode_ = false, reboots_ = false;
    Scan scan_;
    int turns_ = 0; ///< begun since a scan was sent
};

void HokuyoEmulator::hear(std::uint8_t byte) {
    if (byte == '\n' || byte == '\r')
        obey(std::exchange(request_, {}));
    else if (request_.size() < longestRequest)
        request_.push_back(char(byte));
}

void HokuyoEmulator::obey(const std::string &request) {
    if (request.empty())
        return;
    const std::string command = request.substr(0, 2);
    const bool again = std::exchange(reboots_, command == "RB");
    std::string status = "00", lines;
    if (command == "QT" || command == "RS" || (command == "RB" && again)) {
        scan_ = {};
        laser_ = false;
        timeMode_ = timeMode_ && command == "QT";
    } else if (command == "VV" || command == "PP" || command == "II") {
        lines = tell(command);
    } else if (request == "TM0") {
        timeMode_ = scan_.echo.empty();
        status = timeMode_ ? "00" : "0A";
    } else if (request == "TM1" && timeMode_) {
        lines = line(clock(clock_us()));
    } else if (request == "TM2") {
        timeMode_ = false;
    } else if (command == "SS") {
        status = type_.speedStatus;
    } else if (command != "RB" && request != "SCIP2.0") {
        const bool measures = command == "MD" || command == "ME" || command == "GD";
        if (timeMode_)
            status = "0E";
        else if (command == "BM")
            status = std::exchange(laser_, true) ? "02" : "00";
        else
            status = measures ? measureAs(request) : "0A";
    }
    if (command != "GD" || status != "00") // that answers with its scan
        send(request + '\n' + line(status) + lines + '\n');
}

/// Gives the status.
std::string HokuyoEmulator::measureAs(const std::string &request) {
    const bool once = request[0] == 'G';
    const std::string given = request.substr(2, request.find(';') - 2) + (once ? "001" : "");
    if (given.size() < 13 || given.find_first_not_of("0123456789") != given.npos)
        return "01";
    const auto number = [&](std::size_t at, std::size_t size) { return std::stoi(given.substr(at, size)); };
    const Scan scan{request,       number(0, 4), number(4, 4), std::max(1, number(8, 2)),
                    number(10, 1), number(11, 2)};
    if (scan.last > type_.lastStep || scan.first > scan.last)
        return scan.last > type_.lastStep ? "02" : "04";
    if (once && !laser_)
        return "0A";
    laser_ = true;
    scan_ = scan;
    turns_ = scan.skip;
    return "00";
}

void HokuyoEmulator::pass(int step) {
    turns_ += step == 0;
    if (step != fromRear(scan_.last) || turns_ <= scan_.skip)
        return;
    const auto begin = ranges().begin() + fromRear(scan_.first), end = ranges().end();
    std::string values;
    for (auto at = begin; at != end;) {
        const auto next = at + std::min<std::ptrdiff_t>(scan_.cluster, end - at);
        const int least = *std::min_element(at, next);
        const int told = least < nearest_mm ? 0 : least; // what is less is a code
        values += encoded(told, 3) + (scan_.echo[1] == 'E' ? encoded(told > 0 ? stepIntensity : 0, 3) : "");
        at = next;
    }
    const bool last = scan_.count == 1;
    if (!scan_.isOnce() && scan_.count > 0)
        scan_.echo.replace(13, 2, digits(--scan_.count).substr(2));
    std::string text = scan_.echo + '\n' + line(scan_.isOnce() ? "00" : "99") + line(clock(begin_us()));
    for (std::size_t at = 0; at < values.size(); at += lineLength)
        text += line(values.substr(at, lineLength));
    send(text + '\n');
    turns_ = 0;
    if (last)
        scan_ = {};
}

std::string HokuyoEmulator::tell(const std::string &command) const {
    const std::string product = type_.product, range = std::to_string(std::lround(model().range_m * 1000)),
                      speed = std::to_string(std::lround(model().turns_hz * 60));
    if (command == "VV")
        return properties({"VEND:Hokuyo Automatic Co.,Ltd.", "PROD:" + product, "FIRM:3.3.00",
                           "PROT:SCIP 2.0", "SERI:H0000001"});
    if (command == "PP")
        return properties({"MODL:" + product, "DMIN:" + std::to_string(nearest_mm), "DMAX:" + range,
                           "ARES:" + std::to_string(steps()), "AMIN:" + std::to_string(type_.firstStep),
                           "AMAX:" + std::to_string(type_.lastStep), "AFRT:" + std::to_string(type_.front),
                           "SCAN:" + speed});
    return properties({"MODL:" + product, std::string("LASR:") + (laser_ ? "ON" : "OFF"), "SCSP:" + speed,
                       std::string("MESM:") + (scan_.echo.empty() ? "IDLE" : "Measuring"),
                       "TIME:" + clock(clock_us()), "STAT:Sensor works well."});
}

} // namespace

const ScannerModel::Make makeHokuyo = makeOf<HokuyoEmulator>;

} // namespace hermes::simulator
