#pragma once

#include "protocol/velodyne/PacketFormat.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace hermes::velodyne {

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
int mostLasers();
/// What a function says of each, as a list: "a, b or c", with " or " as the last separator.
std::string listSensors(const std::function<std::string(const SensorModel &)> &text, const char *last);
/// "HDL-32E or VLP-16".
std::string sensorNames();
/// Which laser of each looks nearest to the horizon: "HDL-32E: 15, VLP-16: 1".
std::string horizonLasers();
/// As settings and options take them: "auto", "hdl32e" ...
std::vector<std::string> modelChoices();

} // namespace hermes::velodyne
