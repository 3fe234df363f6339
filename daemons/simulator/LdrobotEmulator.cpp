#include "daemons/simulator/ScannerEmulator.h"

namespace hermes::simulator {

namespace {

/// LD06, LD19, STL-27L: one way, packets of 12 points as long as the head turns, clockwise.
class LdrobotEmulator : public ScannerEmulator {
public:
    using ScannerEmulator::ScannerEmulator;

protected:
    void hear(std::uint8_t) override {}
    bool isScanning() const override { return turns(); }

    void sample() override {
        const unsigned angle = stepOf(36000); // 1/100 degree
        if (points_ == 0) {
            packet_ = "\x54\x2C" + bytes16(unsigned(std::lround(speed() * 360))) + bytes16(angle);
        }
        const int mm = range_mm(-turn());
        packet_ += bytes16(unsigned(mm)) + char(mm > 0 ? intensity : 0);
        if (++points_ < pointsPerPacket)
            return;
        points_ = 0;
        packet_ += bytes16(angle) + bytes16(unsigned(clock_us() / 1000 % clockPeriod_ms));
        std::uint8_t crc = 0; // polynomial 4D
        for (const char byte : packet_) {
            crc = std::uint8_t(crc ^ std::uint8_t(byte));
            for (int bit = 0; bit < 8; ++bit)
                crc = std::uint8_t(crc << 1 ^ (crc & 0x80 ? 0x4D : 0));
        }
        packet_.push_back(char(crc));
        send(packet_);
    }

private:
    static constexpr int pointsPerPacket = 12, clockPeriod_ms = 30000, intensity = 228;

    std::string packet_;
    int points_ = 0;
};

} // namespace

const ScannerModel::Make makeLdrobot = makeOf<LdrobotEmulator>;

} // namespace hermes::simulator
