#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace hermes::scan {

/// One measurement of a scanner.
struct Beam {
    double angle_deg = 0; ///< seen from above, counter-clockwise from ahead; of any revolution
    float range_m = 0;    ///< 0: nothing came back
    std::uint8_t intensity = 0;
    std::int64_t stamp_ns = 0; ///< when it was measured: by the host's clock that never jumps, as it is added
};

/// What a scanner measured in one revolution of its head, or one sweep of its field of view:
/// counter-clockwise, so that the stamps of a head that turns clockwise go back. Stamps are since the Unix
/// epoch, by the host's clock.
struct Revolution {
    std::uint64_t number = 0;       ///< counts from 0, with those that are missing
    bool partial = false;           ///< the first, the last, or one of which something is missing
    std::uint64_t lostPackets = 0;  ///< of it, as far as that can be known
    std::int64_t begin_ns = 0;      ///< stamp of the beam that was measured first
    std::int64_t end_ns = 0;        ///< and last
    std::int64_t clockBound_ns = 0; ///< how far the stamps may be off
    std::vector<Beam> beams;        ///< those without return, too
};

/// Cuts the beams of a scanner into revolutions. Keeps its buffers: no allocation once the largest revolution
/// has been seen.
class RevolutionAssembler {
public:
    using Sink = std::function<void(const Revolution &)>;

    struct Counts {
        std::uint64_t revolutions = 0; ///< whole ones
        std::uint64_t partial = 0;     ///< of which something is missing
        std::uint64_t lostPackets = 0;
        /// For which there was time, and of which nothing came: an estimate by how long they take.
        std::uint64_t missed = 0;
    };

    /// The sink sees every revolution and must not keep the reference.
    explicit RevolutionAssembler(Sink sink)
        : sink_(std::move(sink)) {}

    /// A beam of a head that turns clockwise. A revolution begins where the head's own angle falls by more
    /// than 180 degrees; the angle of the beam may lie some degrees beside it. Both in degrees, clockwise
    /// from ahead.
    void addClockwise(double head_deg, double angle_deg, float range_m, std::uint8_t intensity,
                      std::int64_t stamp_ns);
    /// A beam of a sweep, counter-clockwise; endSweep() gives them.
    void add(const Beam &beam) { revolution_.beams.push_back(beam); }
    void endSweep();
    /// Packets are missing between the last beam and the next; 0: nobody knows how many.
    void lose(std::uint64_t packets);
    /// The stamps that follow show that whole revolutions vanished unseen, or fewer than was counted.
    void slip() { isSlip_ = true; }
    /// What follows does not go on where it ended: the revolution under way is given as a partial one.
    void jump();
    /// Nor does its time go on: a replay was sought.
    void seek();
    /// How far the stamps of the beams that follow may be off.
    void setClockBound(std::int64_t bound_ns) { bound_ns_ = bound_ns; }
    /// How far the host's clock is ahead of the one that never jumps.
    void setClockAhead(std::int64_t ahead_ns) { ahead_ns_ = ahead_ns; }

    Counts counts() const;
    /// From one revolution to the next, the median of the last whole ones; 0: not known.
    std::int64_t period_ns() const { return period_ns_; }

private:
    /// Of a beam, or of a sweep's first.
    struct Passage {
        std::int64_t stamp_ns = 0;
        double head_deg = 0; ///< where the head was; of a sweep 0
    };

    double revolutionsOf(std::int64_t time_ns) const;
    void count(bool ends, const Passage &now, double usual);
    void deliver();
    void followPeriod(std::int64_t begin_ns);

    Sink sink_;
    Revolution revolution_;
    Counts counts_;
    std::int64_t turned_ = 0; ///< revolutions that have ended, with those of which nothing came
    std::optional<Passage> last_,
        before_; ///< the last one; the last before a gap, until the clock has settled
    std::int64_t turnedBefore_ = 0, settled_ns_ = 0;
    int inARow_ = 0;                           ///< whole ones
    std::int64_t begin_ns_ = 0;                ///< of the first of them
    std::array<std::int64_t, 5> periods_ns_{}; ///< the last that were measured
    std::size_t periods_ = 0;
    std::int64_t period_ns_ = 0, bound_ns_ = 0, ahead_ns_ = 0;
    bool spins_ = false;
    bool isGap_ = true, isSlip_ = false; ///< before the next beam
};

} // namespace hermes::scan
