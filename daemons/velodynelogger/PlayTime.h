#pragma once

#include "common/capture/Datagram.h"
#include "protocol/velodyne/DataPacket.h"
#include "protocol/velodyne/StampClock.h"

#include <algorithm>
#include <cstdint>

namespace hermes::velodynelogger {

/// How far into a capture a record lies when it is played. Steps back and steps of more than a minute are a
/// clock that was set, not time that passed: they count as nothing. So are steps ahead of more than a second
/// that the sensor's own stamps do not show: these count as the sensor says.
class PlayTime {
public:
    /// Of a capture: time 0 is its first record.
    PlayTime() = default;
    /// Of a recording of a known length that begins at a stamp: time delay_ns is there, and only steps longer
    /// than the recording are a clock that was set.
    PlayTime(std::int64_t start_ns, std::int64_t length_ns, std::int64_t delay_ns)
        : longest_ns_(std::max(minute_ns, length_ns))
        , started_(true)
        , last_ns_(start_ns)
        , now_ns_(delay_ns) {}

    /// Nanoseconds after the beginning; stamps in the order of the file.
    std::int64_t advance(std::int64_t stamp_ns) {
        const std::int64_t step_ns = stamp_ns - last_ns_;
        if (started_ && step_ns > 0 && step_ns <= longest_ns_ && now_ns_ < end_ns)
            now_ns_ += step_ns;
        started_ = true;
        last_ns_ = stamp_ns;
        return now_ns_;
    }
    std::int64_t advance(const Datagram &datagram) {
        if (datagram.size != velodyne::packetSize)
            return advance(datagram.stamp_ns);
        const std::uint32_t stamp_us = velodyne::DataPacket(datagram.payload).stamp_us();
        const std::int64_t waited_ns = datagram.stamp_ns - hostStamp_ns_;
        const std::int64_t sensor_ns = velodyne::nearestHour(stamp_us, std::int64_t(sensorStamp_us_) * 1000) -
                                       std::int64_t(sensorStamp_us_) * 1000;
        const std::int64_t counted_ns = now_ns_ - sensorNow_ns_; // by what came from others since
        if (datagram.source == source_ && sensor_ns >= 0 && waited_ns - sensor_ns > believed_ns)
            last_ns_ = datagram.stamp_ns - std::max<std::int64_t>(0, sensor_ns - counted_ns);
        advance(datagram.stamp_ns);
        source_ = datagram.source;
        hostStamp_ns_ = datagram.stamp_ns;
        sensorStamp_us_ = stamp_us;
        sensorNow_ns_ = now_ns_;
        return now_ns_;
    }
    std::int64_t now_ns() const { return now_ns_; }

    static constexpr std::int64_t end_ns = 1000000000000000000; ///< 30 years: time stands still there

private:
    static constexpr std::int64_t minute_ns = 60000000000;
    static constexpr std::int64_t believed_ns = 1000000000;
    std::int64_t longest_ns_ = minute_ns;
    bool started_ = false;
    std::int64_t last_ns_ = 0; ///< stamp
    std::int64_t now_ns_ = 0;
    // Of the last data packet:
    std::uint32_t source_ = 0;
    std::int64_t hostStamp_ns_ = 0;
    std::uint32_t sensorStamp_us_ = 0;
    std::int64_t sensorNow_ns_ = 0;
};

} // namespace hermes::velodynelogger
