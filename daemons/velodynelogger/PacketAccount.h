#pragma once

#include "common/capture/Frame.h"

#include <vector>

namespace hermes::velodynelogger {

/// What a recording holds by kind, and what its data packets say of those that are missing: every sensor
/// stamps them in even steps.
class PacketAccount {
public:
    struct Counts {
        std::uint64_t packets = 0;  ///< all datagrams
        std::uint64_t data = 0;     ///< data packets of a known sensor
        std::uint64_t position = 0; ///< position packets
        std::uint64_t other = 0;   ///< anything else: foreign, of a wrong size, damaged, of an unknown sensor
        std::uint64_t missing = 0; ///< data packets that ought to stand between those that came
        std::uint64_t late = 0;    ///< data packets older than one before, or the same again
        std::uint64_t sensorClockJumps =
            0;                            ///< the sensor's clock and the host's parted by more than a second
        std::uint64_t hostClockSteps = 0; ///< the host's clock was set back
    };

    void add(const Datagram &datagram);
    const Counts &counts() const { return counts_; }
    /// The last position packet; empty before the first.
    const std::vector<std::uint8_t> &position() const { return position_; }

private:
    void follow(const Datagram &datagram);

    Counts counts_;
    std::vector<std::uint8_t> position_;
    bool started_ = false;
    std::uint32_t source_ = 0; ///< of two sensors on one port the first is followed
    std::int64_t lastStamp_us_ = 0;
    std::int64_t lastReceive_ns_ = 0;
};

} // namespace hermes::velodynelogger
