#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// What the packets of all sensors have in common, as the manual of the HDL-32E (63-9113) gives it. What
/// differs is in SensorModel.h.
namespace hermes::velodyne {

constexpr std::uint16_t dataPort = 2368;     ///< UDP destination port of data packets
constexpr std::uint16_t positionPort = 8308; ///< UDP destination port of position packets

constexpr std::size_t packetSize = 1206; ///< bytes: 12 blocks of 100, stamp of 4, mode, model
constexpr std::size_t positionPacketSize = 512;
constexpr int blocksPerPacket = 12;
constexpr std::size_t blockSize = 100;               ///< bytes: flag 2, azimuth 2, 32 returns of 3
constexpr int slotsPerBlock = 32;                    ///< returns in a block
constexpr std::uint16_t blockFlag = 0xEEFF;          ///< little endian: FF EE on the wire
constexpr std::uint16_t azimuthSteps = 36000;        ///< a turn, in hundredths of a degree
constexpr std::uint32_t stampPeriod_us = 3600000000; ///< the stamp counts microseconds of the hour

/// Byte 1204 of a packet. Blank in firmware before 2.2.20.0 (2016), then zero.
enum class ReturnMode : std::uint8_t { Blank = 0, Strongest = 0x37, Last = 0x38, Dual = 0x39 };

/// Byte 1205 of a packet: the sensor. Those that have no name here are Model(byte).
enum class Model : std::uint8_t { Blank = 0, Hdl32e = 0x21, Vlp16 = 0x22 };

} // namespace hermes::velodyne
