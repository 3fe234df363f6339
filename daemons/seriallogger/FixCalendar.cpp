#include "daemons/seriallogger/FixCalendar.h"

#include <cmath>

namespace hermes::seriallogger {

void FixCalendar::set(const nmea::Date &date, const nmea::UtcTime &time, const Moment &arrival) {
    stamp_ = nmea::toStamp(date, time);
    mono_ns_ = arrival.mono_ns;
}

std::optional<double> FixCalendar::stampOf(const nmea::UtcTime &time, const Moment &arrival) {
    constexpr double day = 86400;
    if (!stamp_)
        return std::nullopt;
    const double expected = *stamp_ + double(arrival.mono_ns - mono_ns_) * 1e-9;
    const double ofDay = time.hour * 3600 + time.minute * 60 + time.second;
    if (const auto date = nmea::dateOf(std::round((expected - ofDay) / day) * day))
        set(*date, time, arrival);
    return stamp_;
}

} // namespace hermes::seriallogger
