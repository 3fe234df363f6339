#pragma once

#include "protocol/nmea/Fields.h"

namespace hermes::nmea {

/// Recommended minimum data of a GPS receiver. What the receiver does not know is empty.
struct Rmc {
    std::optional<UtcTime> time; ///< of the fix, not of its arrival
    std::optional<Date> date;
    bool valid = false; ///< status A, active; the receiver warns of the rest (V)
    std::optional<Position> position;
    std::optional<double> speed;         ///< over ground, m/s
    std::optional<double> course_deg;    ///< over ground, clockwise from true north, 0 to 360
    std::optional<double> variation_deg; ///< of the magnetic from the true north, east positive
    std::optional<char> mode;            ///< since NMEA 2.3: A autonomous, D differential, N not valid, ...
};

/// Reads a sentence of type RMC of any talker. What is wrong reads as unknown (receivers write 999.9 for no
/// variation, or leave out E and W); a fault are only a wrong status, and a time and position with status A.
FieldFault decode(const Sentence &sentence, Rmc &rmc);

/// The whole sentence with CR LF, as in `$GPRMC,214106,A,3707.8178,N,12139.2690,W,010.3,188.2,230715,013.8,
/// E,D*05`. talker: two capital letters; a Velodyne takes GP only, and no more than 72 characters, which the
/// usual decimals keep to. Nothing when a value is no number or does not fit its field.
std::optional<SentenceText> encode(const Rmc &rmc, std::string_view talker = "GP",
                                   const Decimals &decimals = {});

} // namespace hermes::nmea
