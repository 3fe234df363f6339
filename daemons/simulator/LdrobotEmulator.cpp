#include "daemons/simulator/ScannerEmulator.h"
#include "vectorlib/geometry/Angle.h"

#include <cmath>

namespace hermes::simulator {

namespace {

/// LD06, LD19, STL-27L: one way, packets of 12 points as long as the head turns, clockwise.
class LdrobotEmulator : public ScannerEmulator {
public:
    using ScannerEmulator::ScannerEmulator;

protected:
    void hear(std::uint8_t, std::int64_t) override {}
    bool isScanning() const override { return turns(); }

    void sample(std::int64_t time_ns, const Measure &measure) override {
        const unsigned angle = unsigned(std::lround(turn() * 36000) % 36000); // 1/100 degree
        if (points_ == 0) {
            packet_ = "\x54\x2C";
            putU16(packet_, unsigned(std::lround(speed() * 360)));
            putU16(packet_, angle);
        }
        const int mm = range_mm(measure, -2 * vectorlib::pi * turn());
        putU16(packet_, unsigned(mm));
        packet_.push_back(char(mm > 0 ? intensity : 0));
        if (++points_ < pointsPerPacket)
            return;
        points_ = 0;
        putU16(packet_, angle);
        putU16(packet_, unsigned(clock_ms(time_ns) % clockPeriod_ms));
        std::uint8_t crc = 0; // polynomial 4D
        for (const char byte : packet_) {
            crc = std::uint8_t(crc ^ std::uint8_t(byte));
            for (int bit = 0; bit < 8; ++bit)
                crc = std::uint8_t(crc << 1 ^ (crc & 0x80 ? 0x4D : 0));
        }
        packet_.push_back(char(crc));
        send(packet_, time_ns);
    }

private:
    static constexpr int pointsPerPacket = 12, clockPeriod_ms = 30000, intensity = 228;

    std::string packet_;
    int points_ = 0;
};

} // namespace

std::unique_ptr<ScannerEmulator> makeLdrobot(const ScannerModel &model, const ScannerOptions &options) {
    return std::make_unique<LdrobotEmulator>(model, options);
}

} // namespace hermes::simulator
