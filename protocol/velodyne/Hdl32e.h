#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// The Velodyne HDL-32E as its manual (63-9113) gives it: what a packet holds, when and where each laser
/// fires. Packets of a VLP-16 look the same; SensorModel.h has what differs.
namespace hermes::velodyne {

constexpr std::uint16_t dataPort = 2368;     ///< UDP destination port of data packets
constexpr std::uint16_t positionPort = 8308; ///< UDP destination port of position packets

constexpr std::size_t packetSize = 1206; ///< bytes: 12 blocks of 100, stamp of 4, mode, model
constexpr std::size_t positionPacketSize = 512;
constexpr int blocksPerPacket = 12;
constexpr std::size_t blockSize = 100; ///< bytes: flag 2, azimuth 2, 32 returns of 3
constexpr int slotsPerBlock = 32;      ///< returns in a block
constexpr int lasers = 32;
constexpr std::uint16_t blockFlag = 0xEEFF;          ///< little endian: FF EE on the wire
constexpr std::uint16_t azimuthSteps = 36000;        ///< a turn, in hundredths of a degree
constexpr double distanceCounts = 500;               ///< a metre; 0 counts mean no return
constexpr std::uint32_t stampPeriod_us = 3600000000; ///< the stamp counts microseconds of the hour

/// Time between two lasers of a firing: 1.152 us. Manual, appendix on packet timing.
constexpr std::int64_t laserPeriod_ns = 1152;
/// Time between two firings: 32 x 1.152 us + 9.216 us of recharge = 46.080 us.
constexpr std::int64_t firingPeriod_ns = 32 * laserPeriod_ns + 9216;
static_assert(firingPeriod_ns == 46080, "21,701.4 firings a second");
/// Time between two packets of a single return: 552.96 us, or 1,808.45 packets a second.
constexpr std::int64_t packetPeriod_ns = blocksPerPacket * firingPeriod_ns;
/// Part of the way to the next block's azimuth that passes between two lasers: 1.152 / 46.080.
constexpr double laserGap = double(laserPeriod_ns) / double(firingPeriod_ns);

/// The laser that looks along the horizon (elevation 0), the 16th of a block.
constexpr int horizonLaser = 15;

/// Elevation of each laser in the order of firing; degrees above the horizon. Manual, table of vertical
/// angles (its -6.66 and -26.66 rounded to hundredths of a multiple of 4/3 degrees, as all calibration files
/// have them).
constexpr std::array<double, lasers> elevation_deg = {
    -30.67, -9.33,  -29.33, -8.00,  -28.00, -6.67,  -26.67, -5.33,  -25.33, -4.00,  -24.00,
    -2.67,  -22.67, -1.33,  -21.33, 0.00,   -20.00, 1.33,   -18.67, 2.67,   -17.33, 4.00,
    -16.00, 5.33,   -14.67, 6.67,   -13.33, 8.00,   -12.00, 9.33,   -10.67, 10.67};

/// How far above the sensor's origin each laser lies, on the axis of the head; millimetres. Envelope drawing
/// 86-0106 B, as velodyne_decoder 3.0 tells it: no second source was found. All are -28.954 mm times the
/// tangent of the elevation to their last digit: the beams meet in one point that far ahead of the axis.
constexpr std::array<double, lasers> verticalOffset_mm = {
    17.17, 4.76,  16.27, 4.07,  15.40, 3.38,  14.54, 2.70,  13.71, 2.02, 12.89,
    1.35,  12.09, 0.67,  11.31, 0,     10.54, -0.67, 9.78,  -1.35, 9.04, -2.02,
    8.30,  -2.70, 7.58,  -3.38, 6.86,  -4.07, 6.15,  -4.76, 5.45,  -5.45};

/// Byte 1204 of a packet. Blank in firmware before 2.2.20.0 (2016), then zero.
enum class ReturnMode : std::uint8_t { Blank = 0, Strongest = 0x37, Last = 0x38, Dual = 0x39 };

/// Byte 1205 of a packet.
enum class Model : std::uint8_t { Blank = 0, Hdl32e = 0x21, Vlp16 = 0x22 };

} // namespace hermes::velodyne
