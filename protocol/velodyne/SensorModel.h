#pragma once

#include "protocol/velodyne/Hdl32e.h"

#include <string_view>

namespace hermes::velodyne {

/// What differs between the sensors whose packets look alike: how often a block fires, when, and where to.
struct SensorModel {
    Model model;
    const char *name; ///< as people write it: "HDL-32E"
    int lasers;
    int firingsPerBlock;             ///< each of all lasers; their returns follow each other in the block
    std::int64_t laserPeriod_ns;     ///< between two lasers of a firing
    std::int64_t firingPeriod_ns;    ///< between two firings, with the time to recharge
    int horizonLaser;                ///< the one that looks nearest to the horizon
    const double *elevation_deg;     ///< of each laser in the order of firing; degrees above the horizon
    const double *verticalOffset_mm; ///< of each laser: how far it lies above the sensor's origin

    std::int64_t blockPeriod_ns() const { return firingsPerBlock * firingPeriod_ns; }
    /// Firings in a second.
    std::int64_t firingRate() const { return 1000000000 / firingPeriod_ns; }
    /// How many lasers look below this one: 0 for the lowest.
    int ring(int laser) const;
};

const SensorModel &hdl32e();
/// 16 lasers of 2.304 us each and 18.432 us of recharge: 55.296 us a firing, two of them a block.
const SensorModel &vlp16();

/// The sensor with this product byte; that of the HDL-32E for blank. Null for all others.
const SensorModel *findSensorModel(Model model);
/// Of "hdl32e" and "vlp16"; Blank for all else.
Model modelFromText(std::string_view text);

} // namespace hermes::velodyne
