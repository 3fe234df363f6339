#pragma once

#include "protocol/velodyne/PacketDecoder.h"
#include "protocol/velodyne/StampClock.h"

#include <functional>

namespace hermes::velodyne {

/// What came in and what became of it. Every packet is counted once in packets.
struct PacketCounts {
    std::uint64_t packets = 0;
    std::uint64_t wrongSize = 0;
    std::uint64_t wrongFlag = 0;
    std::uint64_t wrongValue = 0; ///< an azimuth or stamp out of its range
    std::uint64_t otherModel = 0; ///< a sensor or return mode that is not decoded
    std::uint64_t outOfOrder = 0; ///< older than its predecessor, or the same again: not decoded
    std::uint64_t lost = 0;       ///< estimated from gaps between stamps
    std::uint64_t gaps = 0;       ///< places where packets were lost
    std::uint64_t clockJumps = 0; ///< the sensor's clock and the receiver's parted by more than a second
};

/// The points of one turn of the head in the order of firing: clockwise seen from above.
struct Turn {
    std::uint64_t number = 0;      ///< counts from 0
    bool partial = false;          ///< the first, the last, or cut by a long gap
    std::int64_t begin_ns = 0;     ///< when its first firing began, since the Unix epoch
    std::int64_t end_ns = 0;       ///< when its last firing ended
    std::uint32_t firings = 0;     ///< with or without return
    std::uint32_t lostPackets = 0; ///< estimated, within this turn
    std::vector<Point> points;
};

/// Cuts the stream of data packets into turns. A turn begins where the azimuth falls by more than 180 degrees
/// from one firing to the next. Keeps its buffers: no allocation once the largest turn has been seen.
class TurnAssembler {
public:
    struct Options {
        int laser = horizonLaser; ///< 0 to 31, or PacketDecoder::allLasers
        Returns returns = Returns::Strongest;
        std::int64_t stampOffset_ns = 0; ///< added to every stamp
    };
    using Sink = std::function<void(const Turn &)>;

    /// The sink sees every complete turn and must not keep the reference.
    TurnAssembler(const Options &options, Sink sink);

    /// Takes the payload of a data packet and the time at which it came in, nanoseconds since the Unix epoch.
    PacketFault feed(const std::uint8_t *bytes, std::size_t size, std::int64_t receive_ns);
    /// Delivers what has been collected of the current turn, as a partial one.
    void finish();
    /// For a new source: forgets the current turn, the clock and the counts.
    void reset();

    const PacketCounts &counts() const { return counts_; }
    /// Turns of the head a minute, from the last complete turn; 0 at first.
    double rpm() const { return rpm_; }

private:
    bool isInOrder(const DataPacket &packet, std::int64_t stamp_ns, std::int64_t receive_ns);
    void noteGap(std::int64_t gap_ns, std::int64_t period_ns);
    void beginTurn(bool partial);
    void endTurn(bool partial);

    Options options_;
    Sink sink_;
    PacketDecoder decoder_;
    StampClock clock_;
    PacketCounts counts_;
    Turn turn_;
    bool started_ = false;
    int lastAzimuth_ = 0;           ///< hundredths of a degree
    std::int64_t lastStamp_ns_ = 0; ///< of the last packet in order
    std::int64_t lastReceive_ns_ = 0;
    std::int64_t nextStamp_ns_ = 0; ///< of the packet that should follow
    double rpm_ = 0;
};

} // namespace hermes::velodyne
