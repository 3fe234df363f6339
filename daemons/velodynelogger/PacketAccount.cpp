#include "daemons/velodynelogger/PacketAccount.h"

#include "protocol/velodyne/DataPacket.h"

#include <algorithm>
#include <cstdlib>

namespace hermes::velodynelogger {

namespace {

constexpr std::int64_t longStep_ns = 1000000000;

/// From one stamp of the hour to the next, the shorter way round.
std::int64_t stampStep(std::int64_t from_us, std::int64_t to_us) {
    constexpr std::int64_t hour_us = velodyne::stampPeriod_us;
    const std::int64_t step = (to_us - from_us) % hour_us;
    return step > hour_us / 2 ? step - hour_us : step < -hour_us / 2 ? step + hour_us : step;
}

/// Nanoseconds until the next packet of this sensor in this mode.
std::int64_t periodOf(const velodyne::DataPacket &packet) {
    return packet.groups() * velodyne::findSensorModel(packet.model())->blockPeriod_ns();
}

} // namespace

void PacketAccount::add(const Datagram &datagram) {
    ++counts_.packets;
    if (datagram.size == velodyne::positionPacketSize) {
        ++counts_.position;
        position_.assign(datagram.payload, datagram.payload + datagram.size);
        return;
    }
    if (velodyne::DataPacket::check(datagram.payload, datagram.size) != velodyne::PacketFault::None) {
        ++counts_.other;
        return;
    }
    ++counts_.data;
    follow(datagram);
}

void PacketAccount::follow(const Datagram &datagram) {
    const velodyne::DataPacket packet(datagram.payload);
    const std::int64_t stamp_us = packet.stamp_us(), period_ns = periodOf(packet);
    if (started_ && datagram.source != source_)
        return;
    const std::int64_t step_us = stampStep(lastStamp_us_, stamp_us);
    const std::int64_t waited_ns = datagram.stamp_ns - lastReceive_ns_;
    const bool first = !started_;
    started_ = true;
    source_ = datagram.source;
    lastReceive_ns_ = datagram.stamp_ns;
    if (!first && waited_ns < 0)
        ++counts_.hostClockSteps;
    if (!first && step_us <= 0 && step_us * 1000 > -longStep_ns) {
        ++counts_.late;
        if (step_us < 0 && counts_.missing > 0) // it was taken for missing
            --counts_.missing;
        return;
    }
    lastStamp_us_ = stamp_us;
    // A short step of the sensor's clock is believed whatever the host's does; a long one only if they agree.
    const std::int64_t step_ns = step_us * 1000;
    if (!first && step_ns > 0 && (step_ns < longStep_ns || std::abs(step_ns - waited_ns) <= longStep_ns))
        counts_.missing +=
            std::uint64_t(std::max<std::int64_t>(0, (step_ns + period_ns / 2) / period_ns - 1));
    else if (!first)
        ++counts_.sensorClockJumps;
}

} // namespace hermes::velodynelogger
