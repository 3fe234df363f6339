#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace hermes::velodyne {

/// What the packets of all sensors have in common, as the manual of the HDL-32E (63-9113) gives it. What
/// differs is in SensorModel.h.
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
constexpr std::int64_t stampPeriod_ns = stampPeriod_us * std::int64_t(1000);

/// Byte 1204 of a packet. Blank in firmware before 2.2.20.0 (2016), then zero.
enum class ReturnMode : std::uint8_t { Blank = 0, Strongest = 0x37, Last = 0x38, Dual = 0x39 };

/// Byte 1205 of a packet: the sensor. Those that have no name here are Model(byte).
enum class Model : std::uint8_t { Blank = 0, Hdl32e = 0x21, Vlp16 = 0x22 };

/// Where one laser of a sensor looks, and from where.
struct Laser {
    double elevation_deg;         ///< above the horizon
    double verticalOffset_mm = 0; ///< how far it lies above the sensor's origin, on the axis of the head
    double azimuthOffset_deg = 0; ///< how far it looks clockwise of the head, to thousandths
};

/// What differs between the sensors whose packets look alike: where their lasers look, when they fire, and
/// what a count of range is. A block holds whole firings of all lasers. A new sensor is a table like that in
/// Vlp16.h.
struct SensorModel {
    Model model;                  ///< byte 1205 of its packets
    const char *key;              ///< as settings and options name it: "hdl32e"
    const char *name;             ///< as people write it: "HDL-32E"
    const Laser *laser;           ///< in the order of their returns in a block
    int lasers;                   ///< how many
    int horizonLaser;             ///< the one that looks nearest to the horizon
    std::int64_t laserPeriod_ns;  ///< from the first lasers of a firing to the next
    std::int64_t firingPeriod_ns; ///< between two firings, with the time to recharge
    int firingsPerBlock = 1;      ///< their returns follow each other
    int lasersAtOnce = 1;         ///< that fire together
    double distanceCounts = 500;  ///< a metre

    constexpr std::int64_t blockPeriod_ns() const { return firingsPerBlock * firingPeriod_ns; }
    /// Between two packets of a single return.
    constexpr std::int64_t packetPeriod_ns() const { return blocksPerPacket * blockPeriod_ns(); }
    /// Firings in a second.
    constexpr std::int64_t firingRate() const { return 1000000000 / firingPeriod_ns; }
    /// How many lasers look below this one: 0 for the lowest.
    int ring(int number) const;
};

/// All that are known, the HDL-32E first.
const std::vector<const SensorModel *> &sensorModels();
/// Makes one known that lives as long as the program; before main() begins, as the initializer of a global
/// constant. Throws std::invalid_argument when its packets could not be told from others or read. Gives true.
bool addSensorModel(const SensorModel &model);

/// The sensor with this product byte; the HDL-32E for blank. Null for all others.
const SensorModel *findSensorModel(Model model);
/// The one that settings name so; Blank for all else.
Model modelFromText(std::string_view key);
/// Of the sensor that has most.
int maxLasers();
/// What a function says of each, as a list: "a, b or c", with " or " as the last separator.
std::string listSensors(const std::function<std::string(const SensorModel &)> &text, const char *last);
/// "HDL-32E or VLP-16".
std::string sensorNames();
/// Which laser of each looks nearest to the horizon: "HDL-32E: 15, VLP-16: 1".
std::string horizonLasers();
/// As settings and options take them: "auto", "hdl32e" ...
std::vector<std::string> modelChoices();

} // namespace hermes::velodyne
