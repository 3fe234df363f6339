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

/// What is to be added to the head's angle, which grows clockwise, for that of a ray; turns.
double correction(int mm) {
    return mm > 0 ? std::atan(21.8 * (155.3 - mm) / (155.3 * mm)) / (2 * vectorlib::pi) : 0;
}

class YdlidarEmulator : public ScannerEmulator {
public:
    YdlidarEmulator(const ScannerModel &model, const ScannerOptions &options)
        : ScannerEmulator(model, options)
        , type_(typeOf(model, ydlidars))
        , scanning_(type_.oneWay) {}

    bool tellsHealth() const override { return !type_.oneWay; }

protected:
    void hear(std::uint8_t byte) override {
        if (last_ == 0xA5 && !type_.oneWay)
            obey(byte);
        last_ = byte;
    }
    bool isScanning() const override { return scanning_ && turns() && !isBroken(); }
    void resume() override { scanning_ = true; }
    void sample() override;

private:
    void obey(std::uint8_t request);
    std::string information() const {
        return std::string{char(type_.model), 5, 1, 1} + std::string(16, '\1');
    }
    void sendPacket(bool first);

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

void YdlidarEmulator::obey(std::uint8_t request) {
    if (request == 0x60 && !isBroken()) {
        send(answerOf(0x81, {}, 5));
        scanning_ = tells_ = true;
    } else if (request == 0x65 || request == 0x00 || request == 0x80) {
        scanning_ = false;
        points_ = 0;
        if (request == 0x80)
            mend();
    } else if (request == 0x90) {
        send(answerOf(0x04, information()));
    } else if (request == 0x92) {
        send(answerOf(0x06, std::string{char(isBroken() ? 2 : 0), char(isBroken() ? 1 : 0), 0}));
    } else if (request == 0x0D) {
        send(answerOf(0x04, bytes32(std::uint32_t(std::lround(speed() * 100))))); // 0.01 Hz
    }
}

void YdlidarEmulator::sample() {
    if (isFirst() && points_ > 0)
        sendPacket(false);
    lastAngle_ = stepOf(360 * 64) << 1 | 1;
    if (points_ == 0) {
        firstAngle_ = lastAngle_;
        samples_.clear();
        sum_ = 0;
    }
    const double ray = turn() + (type_.triangulating ? correction_ : 0);
    const int mm = range_mm(-ray, type_.timeOfFlight ? 65535 : farthest_mm);
    correction_ = correction(mm > 0 ? mm : farthest_mm); // what gives none is far
    const unsigned value = unsigned(type_.timeOfFlight ? mm : mm * 4);
    if (type_.intensity) {
        samples_.push_back(char(mm > 0 ? sampleIntensity : 0));
        sum_ ^= unsigned(mm > 0 ? sampleIntensity : 0);
    }
    samples_ += bytes16(value);
    sum_ ^= value;
    if (++points_ == pointsPerPacket || isFirst())
        sendPacket(isFirst());
}

void YdlidarEmulator::sendPacket(bool first) {
    const double base = type_.timeOfFlight ? 3 : 0;
    const unsigned kind = first ? unsigned(std::lround((speed() - base) * 10)) << 1 | 1 : 0;
    std::string packet;
    for (const unsigned word : {0x55AAU, kind | unsigned(points_) << 8, firstAngle_, lastAngle_}) {
        packet += bytes16(word);
        sum_ ^= word;
    }
    packet += bytes16(sum_);
    points_ = 0;
    send(packet + samples_);
    if (std::exchange(tells_, false))
        send(answerOf(0x04, information()));
}

} // namespace

const ScannerModel::Make makeYdlidar = makeOf<YdlidarEmulator>;

} // namespace hermes::simulator
