#include "protocol/velodyne/TurnAssembler.h"

namespace hermes::velodyne {

namespace {

constexpr std::int64_t second_ns = 1000000000;
/// Half a turn at the highest speed of 20 turns a second: a longer gap may hide the beginning of a turn.
constexpr std::int64_t longGap_ns = second_ns / 40;
/// A longer gap between packets is a clock that was set.
constexpr std::int64_t longestGap_ns = 1800 * second_ns;
/// Beams are counted in one block of so many: to count all takes half of the time of decoding.
constexpr std::uint32_t countEvery = 8;

void count(PacketCounts &counts, PacketFault fault) {
    ++counts.packets;
    counts.wrongSize += fault == PacketFault::Size;
    counts.wrongFlag += fault == PacketFault::Flag;
    counts.wrongValue += fault == PacketFault::Value;
    counts.otherModel += fault == PacketFault::Model;
}

} // namespace

PacketFault TurnAssembler::feed(const std::uint8_t *bytes, std::size_t size, std::int64_t receive_ns,
                                const std::optional<scan::HostClock::Time> &host) {
    PacketFault fault = DataPacket::check(bytes, size, options_.model);
    if (fault == PacketFault::None && !isOfModel(DataPacket(bytes), receive_ns))
        fault = PacketFault::Model;
    count(counts_, fault);
    if (fault == PacketFault::Model) {
        counts_.lastOther = DataPacket(bytes).model();
        counts_.lastOtherMode = DataPacket(bytes).returnMode();
    }
    if (fault != PacketFault::None)
        return fault;
    const DataPacket packet(bytes);
    const std::int64_t measured_ns = host ? host->stamp_ns : clock_.absolute(packet.stamp_us(), receive_ns);
    const std::int64_t stamp_ns = measured_ns + options_.stampOffset_ns;
    if (!isInOrder(packet, stamp_ns, receive_ns))
        return PacketFault::None;
    for (int group = 0; group < packet.groups(); ++group)
        addGroup(packet, group, stamp_ns, host);
    lastStamp_ns_ = stamp_ns;
    lastReceive_ns_ = receive_ns;
    nextStamp_ns_ = stamp_ns + packet.groups() * decoder_->model().blockPeriod_ns();
    return PacketFault::None;
}

bool TurnAssembler::isOfModel(const DataPacket &packet, std::int64_t receive_ns) {
    const bool named = packet.model() != Model::Blank;
    const SensorModel *model = findSensorModel(named ? packet.model() : options_.model);
    if (decoder_ && model == &decoder_->model())
        return true;
    // Of two sensors on one port the first is decoded, until it has been silent for a second.
    if (decoder_ && started_ && std::abs(receive_ns - lastReceive_ns_) < second_ns)
        return false;
    if (decoder_)
        jump();
    decoder_.emplace(*model, options_.laser, options_.returns, options_.verticalOffsets);
    turn_.model = model;
    turn_.laser = decoder_->laser();
    return true;
}

void TurnAssembler::addGroup(const DataPacket &packet, int group, std::int64_t stamp_ns,
                             const std::optional<scan::HostClock::Time> &host) {
    const SensorModel &model = decoder_->model();
    const int azimuth = packet.azimuth(group * packet.returns());
    const bool wraps = turn_.firings > 0 && lastAzimuth_ - azimuth > azimuthSteps / 2;
    // A turn that lasts longer than a second is cut, so that a head that stands still does not fill the
    // memory.
    if (wraps || turn_.firings >= model.firingRate()) {
        endTurn(turn_.partial || !wraps);
        beginTurn(!wraps);
    }
    if (turn_.firings == 0) {
        turn_.begin_ns = stamp_ns + group * model.blockPeriod_ns();
        turn_.clock = host ? StampSource::Host : clock_.isSet() ? StampSource::Gps : StampSource::Sensor;
        turn_.clockBound_ns = host ? host->bound_ns : 0;
    }
    if (turn_.firings / std::uint32_t(model.firingsPerBlock) % countEvery == 0) {
        turn_.beams += std::uint32_t(model.firingsPerBlock * model.lasers);
        turn_.beamsBack += std::uint32_t(packet.filledSlots(group * packet.returns()));
    }
    for (int firing = 0; firing < model.firingsPerBlock; ++firing, ++turn_.firings) {
        if (turn_.firings % options_.firingStep == 0)
            decoder_->decode(packet, group, firing, stamp_ns, turn_.points);
    }
    turn_.end_ns = stamp_ns + (group + 1) * model.blockPeriod_ns();
    lastAzimuth_ = azimuth;
}

bool TurnAssembler::isInOrder(const DataPacket &packet, std::int64_t stamp_ns, std::int64_t receive_ns) {
    if (!started_) {
        started_ = true;
        beginTurn(true);
        return true;
    }
    const std::int64_t step_ns = stamp_ns - lastStamp_ns_;
    const bool parted = std::abs(step_ns - (receive_ns - lastReceive_ns_)) > second_ns;
    // A receiver's clock that is set by whole hours takes the stamps with it.
    if (parted || step_ns < -second_ns || step_ns > longestGap_ns) {
        ++counts_.clockJumps;
        endTurn(true);
        beginTurn(true);
        return true;
    }
    if (step_ns <= 0) {
        ++counts_.outOfOrder;
        return false;
    }
    noteGap(stamp_ns - nextStamp_ns_, packet.groups() * decoder_->model().blockPeriod_ns());
    return true;
}

void TurnAssembler::noteGap(std::int64_t gap_ns, std::int64_t period_ns) {
    const std::int64_t lost = (gap_ns + period_ns / 2) / period_ns; // the stamps are whole microseconds
    if (gap_ns <= 0 || lost <= 0)
        return;
    ++counts_.gaps;
    counts_.lost += std::uint64_t(lost);
    turn_.lostPackets += std::uint32_t(lost);
    if (gap_ns > longGap_ns) {
        endTurn(true);
        beginTurn(true);
    }
}

void TurnAssembler::beginTurn(bool partial) {
    turn_.partial = partial;
    turn_.firings = 0;
    turn_.beams = turn_.beamsBack = 0;
    turn_.lostPackets = 0;
    turn_.points.clear();
}

void TurnAssembler::endTurn(bool partial) {
    if (turn_.firings == 0)
        return;
    turn_.partial = partial;
    if (!partial && turn_.end_ns > turn_.begin_ns) // packets may overlap in time
        rpm_ = 60.0 * second_ns / double(turn_.end_ns - turn_.begin_ns);
    sink_(turn_);
    ++turn_.number;
}

void TurnAssembler::follow(std::optional<std::int64_t> utc_ns) {
    if (utc_ns)
        clock_.follow(*utc_ns);
    else
        clock_.release();
}

void TurnAssembler::finish() {
    endTurn(true);
    beginTurn(true);
}

} // namespace hermes::velodyne
