#pragma once

#include "protocol/nmea/Fields.h"

namespace hermes::nmea {

/// Course and speed over ground. Has no time: it belongs to the sentences around it. What the receiver does
/// not know is empty.
struct Vtg {
    std::optional<double> course_deg; ///< clockwise from true north, 0 to 360
    std::optional<double> speed;      ///< m/s
};

/// Reads a sentence of type VTG of any talker.
/// Of the two speeds the one in knots counts, else the one in km/h.
FieldFault decode(const Sentence &sentence, Vtg &vtg);

} // namespace hermes::nmea
