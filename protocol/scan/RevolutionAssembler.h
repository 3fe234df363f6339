#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace hermes::scan {

/// One measurement of a scanner.
struct Beam {
    double angle_deg = 0; ///< seen from above, counter-clockwise from ahead; of any revolution
    float range_m = 0;    ///< 0: nothing came back
    std::uint8_t intensity = 0;
    std::int64_t stamp_ns = 0; ///< when it was measured, since the Unix epoch, by the host's clock
};

/// What a scanner measured in one revolution of its head, or one sweep of its field of view:
/// counter-clockwise, so that the stamps of a head that turns clockwise go back.
struct Revolution {
    std::uint64_t number = 0;       ///< counts from 0
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
    void endSweep() { deliver(); }
    /// Packets are missing between the last beam and the next; 0: nobody knows how many.
    void lose(std::uint64_t packets);
    /// Whole sweeps are missing before the next.
    void loseSweeps(std::uint64_t sweeps) {
        lose(sweeps);
        revolution_.number += sweeps;
    }
    /// What follows is of another time: the revolution under way is given as a partial one.
    void jump();
    /// How far the stamps of the beams that follow may be off.
    void setClockBound(std::int64_t bound_ns) { bound_ns_ = bound_ns; }

    const Counts &counts() const { return counts_; }

private:
    void deliver();

    Sink sink_;
    Revolution revolution_;
    Counts counts_;
    double head_deg_ = 0;
    std::int64_t bound_ns_ = 0;
    bool spins_ = false;
};

} // namespace hermes::scan
