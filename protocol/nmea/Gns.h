#pragma once

#include "protocol/nmea/Fields.h"

namespace hermes::nmea {

/// The fix of a receiver of several constellations. Has no date. What the receiver does not know is empty;
/// of a sentence for one constellation beside the one for all that is everything but its satellites.
struct Gns {
    std::optional<UtcTime> time; ///< of the fix, not of its arrival
    std::optional<Position> position;
    std::optional<int> quality;     ///< as of GGA, by the best of the constellations
    std::optional<int> satellites;  ///< used for the fix
    std::optional<double> hdop;     ///< horizontal dilution of precision
    std::optional<double> altitude; ///< above mean sea level, m
};

/// Reads a sentence of type GNS of any talker. What stands behind the
/// altitude is not read.
FieldFault decode(const Sentence &sentence, Gns &gns);

} // namespace hermes::nmea
