#pragma once

#include "protocol/nmea/Fields.h"

namespace hermes::nmea {

/// Time and date. What the receiver does not know is empty.
struct Zda {
    std::optional<UtcTime> time;
    std::optional<Date> date;
};

/// Reads a sentence of type ZDA of any talker. The local zone is not read.
FieldFault decode(const Sentence &sentence, Zda &zda);

} // namespace hermes::nmea
