#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace hermes::simulator {

/// What a packet of RPLIDAR holds; those of several samples begin with a checksum and the angle of the head.
struct RplidarCapsule {
    std::size_t samples = 1, bytes = 0;
};
/// packet: 81, 82, 84, 85 or 86, hexadecimal.
RplidarCapsule rplidarCapsule(std::uint8_t packet);

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
