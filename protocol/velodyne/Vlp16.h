#pragma once

#include "protocol/velodyne/SensorModel.h"

namespace hermes::velodyne {

/// The lasers of the VLP-16. Manual 63-9243, table of vertical angles and vertical corrections by laser id.
inline constexpr Laser vlp16Lasers[] = {
    {-15, 11.2}, {1, -0.7}, {-13, 9.7}, {3, -2.2},  {-11, 8.1}, {5, -3.7},  {-9, 6.6}, {7, -5.1},
    {-7, 5.1},   {9, -6.6}, {-5, 3.7},  {11, -8.1}, {-3, 2.2},  {13, -9.7}, {-1, 0.7}, {15, -11.2}};

/// Manual: 16 lasers of 2.304 us each and 18.432 us of recharge, two such firings a block. Of the two lasers
/// nearest to the horizon, the one that looks up.
inline constexpr SensorModel vlp16 = {Model::Vlp16, "vlp16",           "VLP-16", vlp16Lasers, 16, 1,
                                      2304,         16 * 2304 + 18432, 2};
static_assert(vlp16.packetPeriod_ns() == 1327104, "753.5 packets a second");

} // namespace hermes::velodyne
