#pragma once

#include "protocol/scan/HostClock.h"
#include "protocol/velodyne/PacketDecoder.h"

#include <cstdlib>
#include <functional>
#include <optional>

namespace hermes::velodyne {

/// What came in and what became of it. Every packet is counted once in packets.
struct PacketCounts {
    std::uint64_t packets = 0;
    std::uint64_t wrongSize = 0;
    std::uint64_t wrongFlag = 0;
    std::uint64_t wrongValue = 0;   ///< an azimuth or stamp out of its range
    std::uint64_t otherModel = 0;   ///< a sensor or return mode that is not decoded, or a second sensor
    Model lastOther = Model::Blank; ///< of the last packet that otherModel counts, and its mode
    ReturnMode lastOtherMode = ReturnMode::Blank;
    std::uint64_t outOfOrder = 0; ///< older than its predecessor, or the same again: not decoded
    std::uint64_t lost = 0;       ///< estimated from gaps between stamps
    std::uint64_t gaps = 0;       ///< places where packets were lost
    std::uint64_t clockJumps =
        0; ///< the sensor's clock and the receiver's parted by more than a second, or were set

    /// Those that are not decoded for what stands in them.
    std::uint64_t wrong() const { return wrongSize + wrongFlag + wrongValue + otherModel; }
};

/// Whose clock the times of a turn are of.
enum class StampSource {
    Sensor, ///< its own, of which nobody tells how it lies
    Gps,    ///< its own, which a GPS sets
    Host,   ///< the receiver's
};

/// The points of one turn of the head in the order of firing: clockwise seen from above.
struct Turn {
    std::uint64_t number = 0;  ///< counts from 0
    bool partial = false;      ///< the first, the last, or cut by a long gap
    std::int64_t begin_ns = 0; ///< when its first firing began, since the Unix epoch
    std::int64_t end_ns = 0;   ///< when its last firing ended
    StampSource clock = StampSource::Sensor;
    std::int64_t clockBound_ns = 0; ///< how far the times may be off, of the receiver's clock
    std::uint32_t firings = 0;      ///< with or without return, decoded or not
    std::uint32_t beams = 0;        ///< of all lasers, decoded or not, in each eighth block
    std::uint32_t beamsBack = 0;    ///< of them: those with a return
    std::uint32_t lostPackets = 0;  ///< estimated, within this turn
    const SensorModel *model = nullptr;
    int laser = PacketDecoder::allLasers; ///< the one decoded, or allLasers
    std::vector<Point> points;
};

/// Cuts the stream of data packets into turns. A turn begins where the azimuth falls by more than 180 degrees
/// from one firing to the next. Keeps its buffers: no allocation once the largest turn has been seen.
class TurnAssembler {
public:
    struct Options {
        int laser = PacketDecoder::levelLaser; ///< a number, levelLaser or allLasers
        Returns returns = Returns::Strongest;
        bool verticalOffsets = true;     ///< the lasers' own heights are added to z
        std::int64_t stampOffset_ns = 0; ///< added to every stamp
        Model model = Model::Blank;      ///< the sensor; Blank: as the packets say
        std::uint32_t firingStep = 1;    ///< of each turn every n-th firing is decoded
        std::uint64_t firstNumber = 0;   ///< of the first turn
    };
    using Sink = std::function<void(const Turn &)>;

    /// The sink sees every complete turn and must not keep the reference.
    TurnAssembler(const Options &options, Sink sink)
        : options_(options)
        , sink_(std::move(sink)) {
        turn_.number = options.firstNumber;
    }

    /// Takes the payload of a data packet and the time at which it came in, nanoseconds since the Unix epoch.
    /// host: when it was measured by the receiver's clock, if that counts.
    PacketFault feed(const std::uint8_t *bytes, std::size_t size, std::int64_t receive_ns,
                     const std::optional<scan::HostClock::Time> &host = {});
    /// A GPS tells the time, or nothing more: the hour of the stamps that follow.
    void follow(std::optional<std::int64_t> utc_ns);
    /// Delivers what has been collected of the current turn, as a partial one.
    void finish();
    /// The packets that follow are of another time, as after a seek. Counts and numbers go on.
    void jump() {
        finish();
        clock_.reset();
        started_ = false;
    }

    void setFiringStep(std::uint32_t step) { options_.firingStep = step; }
    const PacketCounts &counts() const { return counts_; }
    std::uint64_t turnNumber() const { return turn_.number; } ///< of the one under way
    /// Turns of the head a minute, from the last complete turn; 0 at first.
    double rpm() const { return rpm_; }
    /// The sensor that is decoded; null before the first packet.
    const SensorModel *model() const { return decoder_ ? &decoder_->model() : nullptr; }

private:
    bool isOfModel(const DataPacket &packet, std::int64_t receive_ns);
    void addGroup(const DataPacket &packet, int group, std::int64_t stamp_ns,
                  const std::optional<scan::HostClock::Time> &host);
    bool isInOrder(const DataPacket &packet, std::int64_t stamp_ns, std::int64_t receive_ns);
    void noteGap(std::int64_t gap_ns, std::int64_t period_ns);
    void beginTurn(bool partial);
    void endTurn(bool partial);

    Options options_;
    Sink sink_;
    std::optional<PacketDecoder> decoder_; ///< of the sensor that the packets named
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
