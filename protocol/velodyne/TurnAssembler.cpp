#include "protocol/velodyne/TurnAssembler.h"

#include <cstdlib>

namespace hermes::velodyne {

namespace {

constexpr std::int64_t second_ns = 1000000000;
/// Half a turn at the highest speed of 20 turns a second: a longer gap may hide the beginning of a turn.
constexpr std::int64_t longGap_ns = second_ns / 40;
/// Firings in a second. A turn that lasts longer is cut, so that a head that stands still does not fill the
/// memory.
constexpr std::uint32_t maximumFirings = std::uint32_t(second_ns / firingPeriod_ns);

void count(PacketCounts &counts, PacketFault fault) {
    ++counts.packets;
    counts.wrongSize += fault == PacketFault::Size;
    counts.wrongFlag += fault == PacketFault::Flag;
    counts.wrongValue += fault == PacketFault::Value;
    counts.otherModel += fault == PacketFault::Model;
}

} // namespace

TurnAssembler::TurnAssembler(const Options &options, Sink sink)
    : m_options(options)
    , m_sink(std::move(sink))
    , m_decoder(options.laser, options.returns) {}

PacketFault TurnAssembler::feed(const std::uint8_t *bytes, std::size_t size, std::int64_t receive_ns) {
    const PacketFault fault = DataPacket::check(bytes, size);
    count(m_counts, fault);
    if (fault != PacketFault::None)
        return fault;
    const DataPacket packet(bytes);
    const std::int64_t stamp_ns = m_clock.absolute(packet.stamp_us(), receive_ns) + m_options.stampOffset_ns;
    if (!isInOrder(packet, stamp_ns, receive_ns))
        return PacketFault::None;

    for (int firing = 0; firing < packet.firings(); ++firing) {
        const int azimuth = packet.azimuth(firing * packet.returns());
        const bool wraps = m_turn.firings > 0 && m_lastAzimuth - azimuth > azimuthSteps / 2;
        if (wraps || m_turn.firings >= maximumFirings) {
            endTurn(m_turn.partial || !wraps);
            beginTurn(!wraps);
        }
        if (m_turn.firings == 0)
            m_turn.begin_ns = stamp_ns + firing * firingPeriod_ns;
        m_decoder.decode(packet, firing, stamp_ns, m_turn.points);
        ++m_turn.firings;
        m_turn.end_ns = stamp_ns + (firing + 1) * firingPeriod_ns;
        m_lastAzimuth = azimuth;
    }
    m_lastStamp_ns = stamp_ns;
    m_lastReceive_ns = receive_ns;
    m_nextStamp_ns = stamp_ns + packet.firings() * firingPeriod_ns;
    return PacketFault::None;
}

bool TurnAssembler::isInOrder(const DataPacket &packet, std::int64_t stamp_ns, std::int64_t receive_ns) {
    if (!m_started) {
        m_started = true;
        beginTurn(true);
        return true;
    }
    const std::int64_t step_ns = stamp_ns - m_lastStamp_ns;
    if (std::abs(step_ns - (receive_ns - m_lastReceive_ns)) > second_ns) {
        ++m_counts.clockJumps;
        endTurn(true);
        beginTurn(true);
        return true;
    }
    if (step_ns <= 0) {
        ++m_counts.outOfOrder;
        return false;
    }
    noteGap(stamp_ns - m_nextStamp_ns, packet.firings() * firingPeriod_ns);
    return true;
}

void TurnAssembler::noteGap(std::int64_t gap_ns, std::int64_t period_ns) {
    const std::int64_t lost = (gap_ns + period_ns / 2) / period_ns; // the stamps are whole microseconds
    if (gap_ns <= 0 || lost <= 0)
        return;
    ++m_counts.gaps;
    m_counts.lost += std::uint64_t(lost);
    m_turn.lostPackets += std::uint32_t(lost);
    if (gap_ns > longGap_ns) {
        endTurn(true);
        beginTurn(true);
    }
}

void TurnAssembler::beginTurn(bool partial) {
    m_turn.partial = partial;
    m_turn.firings = 0;
    m_turn.lostPackets = 0;
    m_turn.points.clear();
}

void TurnAssembler::endTurn(bool partial) {
    if (m_turn.firings == 0)
        return;
    m_turn.partial = partial;
    if (!partial)
        m_rpm = 60.0 * second_ns / double(m_turn.end_ns - m_turn.begin_ns);
    m_sink(m_turn);
    ++m_turn.number;
}

void TurnAssembler::finish() {
    endTurn(true);
    beginTurn(true);
}

void TurnAssembler::reset() {
    m_turn.number = 0;
    beginTurn(true);
    m_clock.reset();
    m_counts = PacketCounts();
    m_started = false;
    m_rpm = 0;
}

} // namespace hermes::velodyne
