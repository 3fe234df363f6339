#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hermes::simulator {

/// A packet of RPLIDAR; those of several samples begin with a checksum and the angle of the head.
struct RplidarPacket {
    std::uint8_t type; ///< 81, 82, 84, 85 or 86, hexadecimal
    std::size_t samples, bytes;
    const char *mode; ///< name of the one that sends it
};
const RplidarPacket &rplidarPacket(std::uint8_t type);

std::uint8_t xorOf(std::string_view bytes);

struct RplidarPoint {
    int mm = 0;            ///< 0: none
    double before_deg = 0; ///< by which the ray is at a smaller angle than the head
};

constexpr unsigned rplidarQuality = 47; ///< of each range; made up

/// The before_deg of a ray that found this range: a triangulating sensor looks from beside its axis.
double rplidarSlant_deg(std::uint8_t packet, int mm);

/// A packet other than 81. start: angle of the first sample in 1/64 degree, with bit 15 in the first packet;
/// stamp: of a packet 86. A packet 84 needs the first point of the next one besides.
std::string encodeRplidar(std::uint8_t packet, unsigned start, std::uint32_t stamp_us,
                          const std::vector<RplidarPoint> &points);

} // namespace hermes::simulator
