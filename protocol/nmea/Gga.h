#pragma once

#include "protocol/nmea/Fields.h"

namespace hermes::nmea {

/// The fix of a GPS receiver with its quality. Has no date. What the receiver does not know is empty.
struct Gga {
    std::optional<UtcTime> time; ///< of the fix, not of its arrival
    std::optional<Position> position;
    int quality = 0;                ///< 0 none, 1 GPS, 2 differential, 4 RTK fixed, 5 RTK float, 6 estimated
    std::optional<int> satellites;  ///< used for the fix
    std::optional<double> hdop;     ///< horizontal dilution of precision
    std::optional<double> altitude; ///< above mean sea level, m
    std::optional<double> separation; ///< of the geoid above the ellipsoid, m
    std::optional<double> age_s;      ///< of the differential data
    std::optional<int> station;       ///< that sent the differential data
};

/// Reads a sentence of type GGA of any talker. What is wrong reads as unknown, also the quality (0); a fault
/// are only a time and position with a quality.
FieldFault decode(const Sentence &sentence, Gga &gga);

/// The whole sentence with CR LF. talker: two capital letters. Nothing when a value is no number or does not
/// fit its field.
std::optional<SentenceText> encode(const Gga &gga, std::string_view talker = "GP",
                                   const Decimals &decimals = {});

} // namespace hermes::nmea
