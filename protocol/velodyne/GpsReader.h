#pragma once

#include "protocol/nmea/Rmc.h"
#include "protocol/nmea/SentenceParser.h"
#include "protocol/velodyne/PositionPacket.h"

#include <optional>

namespace hermes::velodyne {

/// What the position packets tell: whether a GPS sets the sensor's clock, and which hour it is.
class GpsReader {
public:
    /// Every position packet is counted once in packets.
    struct Counts {
        std::uint64_t packets = 0;
        std::uint64_t wrongSize = 0;
        std::uint64_t wrongValue = 0;
        std::uint64_t badNmea = 0; ///< the text is no whole sentence, or its fields are wrong
    };
    /// As the last packet had it.
    struct State {
        PositionPacket packet;
        bool valid = false; ///< the text is an RMC that the receiver calls valid
        std::optional<nmea::Position> position;
        /// When the packet was sent; nothing unless the clock is locked to the pulse of a GPS and its RMC is
        /// valid. Hour and date are those of the RMC, which may be a second old, the rest is the sensor's
        /// stamp.
        std::optional<std::int64_t> utc_ns;
    };

    /// Takes the payload of a position packet. A wrong one changes nothing but the counts.
    PositionFault feed(const std::uint8_t *bytes, std::size_t size);

    const State &state() const { return state_; }
    const Counts &counts() const { return counts_; }

private:
    void readText();

    nmea::SentenceParser parser_;
    State state_;
    Counts counts_;
};

} // namespace hermes::velodyne
