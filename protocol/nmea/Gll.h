#pragma once

#include "protocol/nmea/Fields.h"

namespace hermes::nmea {

/// Position and time. Has no date. What the receiver does not know is empty.
struct Gll {
    std::optional<Position> position;
    std::optional<UtcTime> time; ///< of the fix, not of its arrival
    bool valid = false;          ///< status A
};

/// Reads a sentence of type GLL of any talker.
FieldFault decode(const Sentence &sentence, Gll &gll);

} // namespace hermes::nmea
