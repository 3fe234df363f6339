#pragma once

#include <cstdint>

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
    void reset();

private:
    bool started_ = false;
    bool following_ = false;
    std::int64_t last_ns_ = 0;   ///< stamp, or what the GPS told
    std::int64_t offset_ns_ = 0; ///< of the last stamp from its receive time
};

/// Of all times with these microseconds of the hour the one nearest to the reference; nanoseconds.
std::int64_t nearestHour(std::uint32_t stamp_us, std::int64_t reference_ns);

} // namespace hermes::velodyne
