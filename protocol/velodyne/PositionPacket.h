#pragma once

#include "protocol/nmea/Rmc.h"
#include "protocol/nmea/SentenceParser.h"
#include "protocol/velodyne/SensorModel.h"

#include <optional>
#include <string>

namespace hermes::velodyne {

/// Whether the sensor's clock follows the pulse per second of a GPS. Byte 0x0CA of a position packet.
enum class Pps : std::uint8_t { Absent = 0, Synchronizing = 1, Locked = 2, Error = 3 };

/// "absent", "synchronizing", "locked" or "error".
const char *toText(Pps pps);

/// One of the three chips that measure motion: what its words mean by the manual, their axes as it draws
/// them.
struct MotionChip {
    double gyro_dps = 0;      ///< degrees a second, in steps of 0.09766
    double temperature_c = 0; ///< in steps of 0.1453 around 25
    double accelX_g = 0;      ///< in steps of 0.001221
    double accelY_g = 0;
};

/// What a position packet (512 bytes on UDP port 8308) tells. Sources: HDL-32E manual; VLP-16 manual for PPS.
struct PositionPacket {
    std::array<MotionChip, 3> chips;
    std::uint32_t stamp_us = 0; ///< since the top of the hour
    Pps pps = Pps::Absent;
    std::string nmea; ///< the sentence as the sensor got it, without CR LF; empty without GPS
};

/// Longest sentence that a packet has room for, CR LF included.
constexpr std::size_t maximumNmea = 128;

enum class PositionFault {
    None,
    Size,  ///< not 512 bytes
    Value, ///< a stamp beyond the hour, or a state of the PPS that does not exist
};

/// Reads the bytes; packet is changed only without fault. The text is not judged here: it may be anything.
PositionFault decodePosition(const std::uint8_t *bytes, std::size_t size, PositionPacket &packet);

/// The bytes of a packet; values beyond 12 bits are limited. A sentence for which there is no room is left
/// out.
std::array<std::uint8_t, positionPacketSize> encodePosition(const PositionPacket &packet);

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

    /// The sensor was started anew: what its last packet told is over.
    void forget() { state_ = State(); }
    const State &state() const { return state_; }
    const Counts &counts() const { return counts_; }

private:
    void readText();

    nmea::SentenceParser parser_;
    State state_;
    Counts counts_;
};

} // namespace hermes::velodyne
