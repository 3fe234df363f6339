#pragma once

#include "protocol/velodyne/DataPacket.h"

#include <vector>

namespace hermes::velodyne {

/// One measurement. Sensor frame: x forward (azimuth 0), y left, z up; metres.
struct Point {
    std::int64_t stamp_ns = 0; ///< since the Unix epoch
    double azimuth = 0;        ///< degrees, clockwise seen from above, in [0, 360)
    double range = 0;          ///< metres from the sensor's centre
    double x = 0;
    double y = 0;
    double z = 0;
    std::uint8_t laser = 0;
    std::uint8_t intensity = 0;
};

/// Which returns of a dual-return packet are taken; single-return packets have only the one.
enum class Returns { Strongest, Last, Both };

/// Turns the firings of one packet into points, each at the azimuth and time at which its own laser fired.
class PacketDecoder {
public:
    static constexpr int allLasers = -1;

    /// laser: 0 to 31, or allLasers.
    explicit PacketDecoder(int laser = horizonLaser, Returns returns = Returns::Strongest);

    /// Appends the points of a firing (0 to packet.firings() - 1) in the order in which the lasers fired.
    /// Points without return are left out. packetStamp_ns: when the first laser of the packet fired, since
    /// the Unix epoch.
    void decode(const DataPacket &packet, int firing, std::int64_t packetStamp_ns,
                std::vector<Point> &points) const;

private:
    int firstLaser_;
    int lastLaser_;
    Returns returns_;
    std::array<double, lasers> cosElevation_;
    std::array<double, lasers> sinElevation_;
};

/// How far the head turned during a firing: to the next block's azimuth; for the last firing of a packet as
/// far as for the one before. Hundredths of a degree; 0 where azimuths stand still or jump by more than
/// maximumGap.
int azimuthGap(const DataPacket &packet, int firing);

/// Hundredths of a degree: beyond it two blocks do not follow each other (20 turns a second make 33).
constexpr int maximumGap = 300;

} // namespace hermes::velodyne
