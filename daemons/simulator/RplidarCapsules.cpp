#include "daemons/simulator/RplidarCapsules.h"
#include "daemons/simulator/ScannerEmulator.h"
#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hermes::simulator {

namespace {

/// Of the rays of packets 84: a triangulating sensor looks from beside its axis.
double slant_deg(int mm) {
    if (mm < 50)
        return 7.5;
    const int m = 98361 / (4 * mm);
    return (9150 - 64 * m - double(m) * m * m / 98304) / 65536 * 180 / vectorlib::pi;
}

/// A range in 12 bits: the step doubles from level to level.
struct Level {
    int code, mm, shift;
};
constexpr std::array<Level, 5> levels{
    {{3328, 16384, 4}, {1792, 4096, 3}, {1280, 2048, 2}, {512, 512, 1}, {0, 0, 0}}};
constexpr int noPrediction = -512;

struct Major {
    unsigned code = 0;
    int mm = 0, shift = 0; ///< as the host reads them
};

Major majorOf(int mm) {
    for (const Level &level : levels) {
        const int steps = (mm - level.mm) >> level.shift;
        if (mm >= level.mm && level.code + steps <= 0xFFF)
            return {unsigned(level.code + steps), level.mm + (steps << level.shift), level.shift};
        if (mm >= level.mm)
            break; // too far
    }
    return {};
}

/// 10 bits: the way from a major range to another one.
unsigned prediction(const Major &major, int mm) {
    const int steps = (mm - major.mm) >> major.shift;
    return unsigned(mm > 0 && std::abs(steps) < 511 ? steps : noPrediction) & 0x3FF;
}

/// Of a packet 86: 20 bits.
std::uint32_t scaled(int mm) {
    struct Scale {
        int mm, step, bits;
    };
    constexpr std::array<Scale, 4> scales{{{0, 2, 10}, {2046, 3, 11}, {8187, 4, 12}, {24567, 5, 13}}};
    unsigned i = 3;
    while (mm < scales[i].mm)
        --i;
    const std::uint32_t steps = std::uint32_t((mm - scales[i].mm) / scales[i].step);
    return i | steps << 2 | (mm > 0 ? rplidarQuality >> i : 0) << (2 + scales[i].bits);
}

std::string bodyOf(std::uint8_t packet, const std::vector<RplidarPoint> &points) {
    std::string body;
    if (packet == 0x85) {
        for (const RplidarPoint &point : points)
            body += bytes16(unsigned(point.mm));
        return body;
    }
    if (packet == 0x84) {
        for (std::size_t i = 0; i + 3 < points.size(); i += 3) {
            const Major first = majorOf(points[i].mm), next = majorOf(points[i + 3].mm);
            body += bytes32(first.code | prediction(first.mm > 0 ? first : next, points[i + 1].mm) << 12 |
                            prediction(next, points[i + 2].mm) << 22);
        }
        return body;
    }
    for (std::size_t i = 0; i + 1 < points.size(); i += 2) {
        const RplidarPoint &a = points[i], &b = points[i + 1];
        if (packet == 0x86) {
            const std::uint32_t first = scaled(a.mm), second = scaled(b.mm);
            body += bytes16(first & 0xFFFF) + bytes16(second & 0xFFFF);
            body.push_back(char(first >> 16 | second >> 16 << 4));
        } else {
            const unsigned first = unsigned(a.before_deg * 8), second = unsigned(b.before_deg * 8);
            body += bytes16(unsigned(a.mm) << 2 | first >> 4) + bytes16(unsigned(b.mm) << 2 | second >> 4);
            body.push_back(char((first & 15) | (second & 15) << 4));
        }
    }
    return body;
}

} // namespace

const RplidarPacket &rplidarPacket(std::uint8_t type) {
    static constexpr std::array<RplidarPacket, 5> packets{{{0x81, 1, 5, "Standard"},
                                                           {0x82, 32, 84, "Express"},
                                                           {0x84, 96, 132, "Sensitivity"},
                                                           {0x85, 40, 84, "DenseBoost"},
                                                           {0x86, 64, 170, "UltraDense"}}};
    return *std::find_if(packets.begin(), packets.end() - 1,
                         [type](const RplidarPacket &p) { return p.type == type; });
}

std::uint8_t xorOf(std::string_view bytes) {
    std::uint8_t sum = 0;
    for (const char byte : bytes)
        sum = std::uint8_t(sum ^ std::uint8_t(byte));
    return sum;
}

double rplidarSlant_deg(std::uint8_t packet, int mm) {
    if (packet == 0x84)
        return slant_deg(mm);
    return packet == 0x82 ? std::floor(std::clamp(slant_deg(mm) * 8, 0.0, 63.0)) / 8 : 0;
}

std::string encodeRplidar(std::uint8_t packet, unsigned start, std::uint32_t stamp_us,
                          const std::vector<RplidarPoint> &points) {
    const std::string time = packet == 0x86 ? bytes32(stamp_us) + bytes16(0) : ""; // and the state
    const std::string body = time + bytes16(start) + bodyOf(packet, points);
    const std::uint8_t sum = xorOf(body);
    return std::string{char(0xA0 | (sum & 15)), char(0x50 | sum >> 4)} + body;
}

} // namespace hermes::simulator
