#pragma once

#include "protocol/velodyne/DataPacket.h"

#include <cstdint>
#include <vector>

namespace hermes::velodyne {

/// Makes absolute times of the sensor's stamps, which count microseconds of the hour only. The hour of the
/// first packet is the one that brings it within half an hour of its receive time; from then on the hour
/// follows the packets, so that a sensor without GPS, whose hour begins anywhere, does not jump. As long as a
/// GPS tells the hour, the receiver's clock has no say.
class StampClock {
public:
    /// Nanoseconds since the Unix epoch. receive_ns: when the packet came in, on the same scale.
    std::int64_t absolute(std::uint32_t stamp_us, std::int64_t receive_ns);
    /// A GPS tells the time: of the stamps that follow the first lies within half an hour of it.
    void follow(std::int64_t utc_ns);
    /// It tells it no longer.
    void release() { following_ = false; }
    /// A GPS has told the time since the last reset().
    bool isSet() const { return isSet_; }
    void reset() { *this = StampClock(); }

private:
    bool started_ = false;
    bool following_ = false;
    bool isSet_ = false;
    std::int64_t last_ns_ = 0;   ///< stamp, or what the GPS told
    std::int64_t offset_ns_ = 0; ///< of the last stamp from its receive time
};

/// Of all times with these microseconds of the hour the one nearest to the reference; nanoseconds.
std::int64_t nearestHour(std::uint32_t stamp_us, std::int64_t reference_ns);

/// One measurement. Sensor frame: x forward (azimuth 0), y left, z up; metres.
struct Point {
    std::int64_t stamp_ns = 0; ///< since the Unix epoch
    double azimuth = 0;        ///< degrees, clockwise seen from above, in [0, 360)
    double range = 0;          ///< metres from the laser, which lies in or near the sensor's origin
    double x = 0;
    double y = 0;
    double z = 0;
    std::uint8_t laser = 0;
    std::uint8_t intensity = 0;
};

/// Which returns of a dual-return packet are taken; single-return packets have only the one.
enum class Returns { Strongest, Last, Both };

/// Of "last" and "both"; Strongest for all else.
Returns returnsFromText(std::string_view text);

/// Turns the firings of one packet into points, each at the azimuth and time at which its own laser fired.
/// Azimuth and range are the doubles nearest to the exact values, so that independent decoders agree to the
/// last bit.
class PacketDecoder {
public:
    static constexpr int allLasers = -1;
    /// The laser of the sensor that looks nearest to the horizon.
    static constexpr int levelLaser = -2;

    /// laser: a number, allLasers or levelLaser. A number that the sensor has not gives no points.
    /// verticalOffsets: each laser lies where the model says, else all in the sensor's origin; that is in z
    /// alone.
    explicit PacketDecoder(const SensorModel &model, int laser = levelLaser,
                           Returns returns = Returns::Strongest, bool verticalOffsets = true);

    /// Appends the points of a firing of a group of blocks (0 to packet.groups() - 1, each with
    /// model.firingsPerBlock firings) in the order in which the lasers fired. Points without return are left
    /// out. packetStamp_ns: when the first laser of the packet fired, since the Unix epoch.
    void decode(const DataPacket &packet, int group, int firing, std::int64_t packetStamp_ns,
                std::vector<Point> &points) const;

    const SensorModel &model() const { return *model_; }
    /// The number of the laser, or allLasers.
    int laser() const { return laser_; }

private:
    const SensorModel *model_;
    int laser_;
    Returns returns_;
    /// Of each laser what its table says, ready for use.
    struct Beam {
        double cosElevation, sinElevation;
        double height;         ///< above the sensor's origin; metres
        std::int64_t after_ns; ///< the first of the firing
        std::int64_t
            azimuthOffset; ///< from 0 to below a turn; thousandths of a degree times the block's period
    };
    std::array<Beam, slotsPerBlock> beams_{};
};

/// How far the head turned during a group of blocks: to the next block's azimuth; for the last group of a
/// packet as far as for the one before. Hundredths of a degree; 0 where azimuths stand still or jump by more
/// than maximumGap.
int azimuthGap(const DataPacket &packet, int group);

/// Hundredths of a degree: beyond it two blocks do not follow each other (20 turns a second of a VLP-16 make
/// 80).
constexpr int maximumGap = 300;

} // namespace hermes::velodyne
