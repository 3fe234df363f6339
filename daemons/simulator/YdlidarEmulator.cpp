#include "daemons/simulator/ScannerEmulator.h"
#include "vectorlib/geometry/Angle.h"

#include <cmath>
#include <utility>

namespace hermes::simulator {

namespace {

struct Ydlidar {
    const char *name;
    std::uint8_t model;
    bool oneWay;
    bool intensity;     ///< one byte before each range
    bool timeOfFlight;  ///< ranges in mm, not in quarters of it; speed from 3 turns a second on
    bool triangulating; ///< it looks from beside its axis
};

const std::vector<Ydlidar> ydlidars{{"ydlidar-x2", 4, true, false, false, true},
                                    {"ydlidar-x4", 6, false, false, false, true},
                                    {"ydlidar-tmini", 150, false, true, false, false},
                                    {"ydlidar-tg30", 101, false, false, true, false}};
constexpr int farthest_mm = 0x3FFF, pointsPerPacket = 40, sampleIntensity = 128;

/// What is to be added to the head's angle, which grows clockwise, for that of a ray.
double correction_rad(int mm) {
    return mm > 0 ? std::atan(21.8 * (155.3 - mm) / (155.3 * mm)) : 0;
}

class YdlidarEmulator : public ScannerEmulator {
public:
    YdlidarEmulator(const ScannerModel &model, const ScannerOptions &options)
        : ScannerEmulator(model, options)
        , type_(typeOf(model, ydlidars))
        , scanning_(type_.oneWay) {}

protected:
    void hear(std::uint8_t byte, std::int64_t now_ns) override {
        if (last_ == 0xA5 && !type_.oneWay)
            obey(byte, now_ns);
        last_ = byte;
    }
    bool isScanning() const override { return scanning_ && turns() && !isBroken(); }
    void resume() override { scanning_ = true; }
    void sample(std::int64_t time_ns, const Measure &measure) override;

private:
    void obey(std::uint8_t request, std::int64_t now_ns);
    std::string information() const {
        return std::string{char(type_.model), 5, 1, 1} + std::string(16, '\1');
    }
    void sendPacket(std::int64_t time_ns, bool first);

    const Ydlidar &type_;
    bool scanning_;
    bool tells_ = false; ///< what it is, once within the data
    std::uint8_t last_ = 0;
    double correction_ = 0; ///< of the ray before
    unsigned firstAngle_ = 0, lastAngle_ = 0;
    int points_ = 0;
    std::string samples_;
    unsigned sum_ = 0; ///< of the samples
};

void YdlidarEmulator::obey(std::uint8_t request, std::int64_t now_ns) {
    if (request == 0x60 && !isBroken()) {
        send(answerOf(0x81, {}, 5), now_ns);
        scanning_ = tells_ = true;
    } else if (request == 0x65 || request == 0x00 || request == 0x80) {
        scanning_ = false;
        points_ = 0;
        if (request == 0x80)
            mend();
    } else if (request == 0x90) {
        send(answerOf(0x04, information()), now_ns);
    } else if (request == 0x92) {
        send(answerOf(0x06, std::string{char(isBroken() ? 2 : 0), char(isBroken() ? 1 : 0), 0}), now_ns);
    } else if (request == 0x0D) {
        std::string speed; // hundredths of a turn a second
        putU32(speed, std::uint32_t(std::lround(this->speed() * 100)));
        send(answerOf(0x04, speed), now_ns);
    }
}

void YdlidarEmulator::sample(std::int64_t time_ns, const Measure &measure) {
    if (isFirst() && points_ > 0)
        sendPacket(time_ns, false);
    lastAngle_ = unsigned(std::lround(turn() * 360 * 64) % (360 * 64)) << 1 | 1;
    if (points_ == 0) {
        firstAngle_ = lastAngle_;
        samples_.clear();
        sum_ = 0;
    }
    const double ray = 2 * vectorlib::pi * turn() + (type_.triangulating ? correction_ : 0);
    const int mm = range_mm(measure, -ray, type_.timeOfFlight ? 65535 : farthest_mm);
    correction_ = correction_rad(mm > 0 ? mm : farthest_mm); // what gives none is far
    const unsigned value = unsigned(type_.timeOfFlight ? mm : mm * 4);
    if (type_.intensity) {
        samples_.push_back(char(mm > 0 ? sampleIntensity : 0));
        sum_ ^= unsigned(mm > 0 ? sampleIntensity : 0);
    }
    putU16(samples_, value);
    sum_ ^= value;
    if (++points_ == pointsPerPacket || isFirst())
        sendPacket(time_ns, isFirst());
}

void YdlidarEmulator::sendPacket(std::int64_t time_ns, bool first) {
    const double base = type_.timeOfFlight ? 3 : 0;
    const unsigned kind = first ? unsigned(std::lround((speed() - base) * 10)) << 1 | 1 : 0;
    std::string packet;
    for (const unsigned word : {0x55AAU, kind | unsigned(points_) << 8, firstAngle_, lastAngle_}) {
        putU16(packet, word);
        sum_ ^= word;
    }
    putU16(packet, sum_);
    points_ = 0;
    send(packet + samples_, time_ns);
    if (std::exchange(tells_, false))
        send(answerOf(0x04, information()), time_ns);
}

} // namespace

std::unique_ptr<ScannerEmulator> makeYdlidar(const ScannerModel &model, const ScannerOptions &options) {
    return std::make_unique<YdlidarEmulator>(model, options);
}

} // namespace hermes::simulator
