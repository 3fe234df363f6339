#pragma once

#include "protocol/nmea/Fields.h"

#include <optional>

namespace hermes::seriallogger {

/// What one sentence of a GPS receiver tells of a fix; what it does not tell is empty.
struct FixReport {
    enum class Kind { Rmc, Gga, Gns, Gll, Vtg, Zda };
    static constexpr std::size_t kinds = 6;

    Kind kind = Kind::Rmc;
    std::optional<nmea::UtcTime> time; ///< of the fix
    std::optional<nmea::Date> date;
    std::optional<bool> valid; ///< whether the receiver vouches for the position
    std::optional<nmea::Position> position;
    std::optional<int> quality;
    std::optional<int> satellites;
    std::optional<double> hdop;
    std::optional<double> altitude; ///< m
    std::optional<double> speed;    ///< m/s
    std::optional<double> course_deg;

    /// Nothing of a sentence of another type, or with a fault.
    static std::optional<FixReport> read(const nmea::Sentence &sentence, nmea::FieldFault &fault);
};

} // namespace hermes::seriallogger
