#pragma once

#include "protocol/velodyne/SensorModel.h"

namespace hermes::velodyne {

/// The lasers of the HDL-32E. Elevations: manual 63-9113, table of vertical angles (its -6.66 and -26.66
/// rounded to hundredths of a multiple of 4/3 degrees, as all calibration files have them). Heights: envelope
/// drawing 86-0106 B, as velodyne_decoder 3.0 tells it: no second source was found. All are -28.954 mm times
/// the tangent of the elevation to their last digit: the beams meet in one point that far ahead of the axis.
inline constexpr Laser hdl32eLasers[] = {
    {-30.67, 17.17}, {-9.33, 4.76}, {-29.33, 16.27}, {-8.00, 4.07}, {-28.00, 15.40}, {-6.67, 3.38},
    {-26.67, 14.54}, {-5.33, 2.70}, {-25.33, 13.71}, {-4.00, 2.02}, {-24.00, 12.89}, {-2.67, 1.35},
    {-22.67, 12.09}, {-1.33, 0.67}, {-21.33, 11.31}, {0.00, 0},     {-20.00, 10.54}, {1.33, -0.67},
    {-18.67, 9.78},  {2.67, -1.35}, {-17.33, 9.04},  {4.00, -2.02}, {-16.00, 8.30},  {5.33, -2.70},
    {-14.67, 7.58},  {6.67, -3.38}, {-13.33, 6.86},  {8.00, -4.07}, {-12.00, 6.15},  {9.33, -4.76},
    {-10.67, 5.45},  {10.67, -5.45}};

/// Manual, appendix on packet timing: 32 lasers of 1.152 us each and 9.216 us of recharge.
inline constexpr SensorModel hdl32e = {Model::Hdl32e, "hdl32e",        "HDL-32E", hdl32eLasers, 32, 15,
                                       1152,          32 * 1152 + 9216};
static_assert(hdl32e.packetPeriod_ns() == 552960, "1,808.45 packets and 21,701.4 firings a second");

} // namespace hermes::velodyne
