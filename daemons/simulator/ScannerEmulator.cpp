#include "daemons/simulator/ScannerEmulator.h"
#include "vectorlib/geometry/Angle.h"

namespace hermes::simulator {

namespace {

constexpr std::int64_t longestStep_ns = 10000000000; // more is a pause, in which nothing happened
constexpr std::int64_t clockAhead_us = 23456000;     // at the start; made up
constexpr int usbBaud = 12000000;
constexpr int bitsPerByte = 10;
constexpr int heldBytes = 7; // no packet has so few, but those of 5: it ends in the middle

} // namespace

const std::vector<ScannerModel> &scannerModels() {
    // name, family, baud, points a second, turns a second, range
    static const std::vector<ScannerModel> models{
        {"rplidar-a1", makeRplidar, 115200, 8000, 10, 12}, //
        {"rplidar-a3", makeRplidar, 256000, 16000, 10, 25},
        {"rplidar-c1", makeRplidar, 460800, 5000, 10, 12},
        {"rplidar-s2", makeRplidar, 1000000, 32000, 10, 30},
        {"ld06", makeLdrobot, 230400, 4500, 10, 12},
        {"ld19", makeLdrobot, 230400, 4500, 10, 12},
        {"stl27l", makeLdrobot, 921600, 21600, 10, 25},
        {"ydlidar-x2", makeYdlidar, 115200, 3000, 7, 8},
        {"ydlidar-x4", makeYdlidar, 128000, 5000, 7, 10},
        {"ydlidar-tmini", makeYdlidar, 230400, 4000, 10, 12},
        {"ydlidar-tg30", makeYdlidar, 512000, 20000, 10, 30},
        {"hokuyo-urg04lx", makeHokuyo, 0, 10240, 10, 5.6},
        {"hokuyo-ust10lx", makeHokuyo, 0, 57600, 40, 10},
        {"sick-tim551", makeSick, 0, 5400, 15, 10},
        {"sick-tim571", makeSick, 0, 16200, 15, 25},
        {"sick-lms111", makeSick, 0, 36000, 50, 20},
    };
    return models;
}

std::unique_ptr<ScannerEmulator> makeScanner(std::string_view name, const ScannerOptions &options) {
    for (const ScannerModel &model : scannerModels()) {
        if (model.name == name)
            return model.make(model, options);
    }
    return nullptr;
}

ScannerEmulator::ScannerEmulator(const ScannerModel &model, const ScannerOptions &options)
    : model_(model)
    , options_(options)
    , random_(std::minstd_rand::result_type(options.seed))
    , turns_hz_(model.turns_hz)
    , period_(1e9 / model.points_hz) {}

void ScannerEmulator::begin(std::int64_t now_ns) {
    if (start_ns_ == 0)
        start_ns_ = next_ns_ = now_ns;
}

void ScannerEmulator::receive(std::string_view bytes, std::int64_t now_ns) {
    begin(now_ns);
    now_ns_ = now_ns;
    for (const char byte : bytes) {
        if (fault_.kind != Fault::Kind::Silence)
            hear(std::uint8_t(byte));
    }
}

void ScannerEmulator::disconnect() {
    unsend();
    request_.clear();
    hangUp();
}

std::string_view ScannerEmulator::take(std::int64_t now_ns, const Measure &measure) {
    begin(now_ns);
    measure_ = &measure;
    next_ns_ = now_ns - next_ns_ > longestStep_ns ? now_ns : next_ns_;
    while (next_ns_ <= now_ns) {
        turn_ += turns() ? turns_hz_ * period_ * 1e-9 : 0;
        first_ = turn_ > 1 - 1e-9; // but for rounding it is 1
        if (first_) {
            turn_ = std::max(turn_ - 1, 0.0);
            ++revolutions_;
        }
        now_ns_ = next_ns_;
        if (isScanning())
            sample();
        rest_ns_ += period_;
        next_ns_ += std::int64_t(rest_ns_);
        rest_ns_ -= std::floor(rest_ns_);
    }
    const double byte_ns = 1e9 * bitsPerByte / (model_.baud > 0 ? model_.baud : usbBaud);
    const double left = std::max(0.0, double(now_ns - start_ns_) - lineFree_ns_) / byte_ns;
    const std::size_t count = std::min(pending_.size(), std::size_t(left));
    lineFree_ns_ += double(count) * byte_ns;
    told_.clear();
    for (char byte : std::string_view(pending_).substr(0, count)) {
        if (held_ > 0) {
            --held_;
            continue;
        }
        if (fault_.kind == Fault::Kind::Silence || (fault_.kind == Fault::Kind::Loss && chance(fault_.share)))
            continue;
        if (fault_.kind == Fault::Kind::Corrupt && chance(fault_.share))
            byte = char(byte ^ (1 << random_() % 8));
        told_.push_back(byte);
    }
    pending_.erase(0, count);
    return told_;
}

void ScannerEmulator::setFault(const Fault &fault) {
    fault_ = fault;
    if (fault.kind != Fault::Kind::Held)
        return;
    pending_.clear();
    held_ = heldBytes;
    if (!isScanning())
        resume();
}

void ScannerEmulator::send(std::string_view bytes, double later_ns) {
    if (pending_.empty())
        lineFree_ns_ = std::max(lineFree_ns_, double(now_ns_ - start_ns_) + later_ns);
    pending_ += bytes;
}

std::int64_t ScannerEmulator::clock_us() const {
    return clockAhead_us + std::int64_t(double(now_ns_ - start_ns_) * (1 + options_.drift_ppm * 1e-6) * 1e-3);
}

int ScannerEmulator::range_mm(double turns, int largest) const {
    const double range = (*measure_)(2 * vectorlib::pi * turns);
    const long mm = std::lround(range * 1000);
    return range <= model_.range_m && mm > 0 && mm <= largest ? int(mm) : 0;
}

std::string bytes16(unsigned value) {
    return {char(value), char(value >> 8)};
}

std::string bytes32(std::uint32_t value) {
    return bytes16(value & 0xFFFF) + bytes16(value >> 16);
}

std::string answerOf(std::uint8_t type, std::string_view bytes, std::size_t packetSize) {
    const std::size_t size = packetSize > 0 ? packetSize | 1U << 30 : bytes.size();
    return "\xA5\x5A" + bytes32(std::uint32_t(size)) + char(type) + std::string(bytes);
}

} // namespace hermes::simulator
