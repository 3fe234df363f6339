#pragma once

#include <cstdint>

namespace hermes::velodyne {

/// Makes absolute times of the sensor's stamps, which count microseconds of the hour only. The hour of the
/// first packet is the one that brings it within half an hour of its receive time; from then on the hour
/// follows the packets, so that a sensor without GPS, whose hour begins anywhere, does not jump.
class StampClock {
public:
    /// Nanoseconds since the Unix epoch. receive_ns: when the packet came in, on the same scale.
    std::int64_t absolute(std::uint32_t stamp_us, std::int64_t receive_ns);
    void reset() { started_ = false; }

private:
    bool started_ = false;
    std::int64_t offset_ns_ = 0; ///< of the last stamp from its receive time
};

} // namespace hermes::velodyne
