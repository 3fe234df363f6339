#pragma once

#include <optional>

namespace hermes::nmea {

/// Time of day, UTC. second may reach below 61 in a leap second.
struct UtcTime {
    int hour = 0;
    int minute = 0;
    double second = 0;
    int decimals = 0; ///< of the second, as it was written
};

struct Date {
    int year = 1970;
    int month = 1; ///< from 1
    int day = 1;   ///< from 1
};

/// Whether there is such a time (of a day with a leap second) or date.
bool isValid(const UtcTime &time);
bool isValid(const Date &date);

/// Seconds since the Unix epoch; a leap second counts as the first second of the next day. Nothing for what
/// is not valid.
std::optional<double> toStamp(const Date &date, const UtcTime &time);

/// What the clock shows at a stamp. Nothing for stamps that are no number, before 1970 or after 9999.
std::optional<UtcTime> timeOf(double stamp);
std::optional<Date> dateOf(double stamp);

} // namespace hermes::nmea
