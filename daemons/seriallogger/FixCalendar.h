#pragma once

#include "common/Time.h"
#include "protocol/nmea/UtcTime.h"

#include <cmath>

namespace hermes::seriallogger {

/// Knows which day a time of day belongs to, from the last sentence that told the date and the time that went
/// by since.
class FixCalendar {
public:
    /// A sentence that arrived then told the date.
    void set(const nmea::Date &date, const nmea::UtcTime &time, const Moment &arrival) {
        stamp_ = nmea::toStamp(date, time);
        mono_ns_ = arrival.mono_ns;
    }
    bool isSet() const { return stamp_.has_value(); }
    /// Seconds since the Unix epoch of a time that arrived then, of the day that brings it nearest to the one
    /// expected; it is remembered. Nothing before a date was told.
    std::optional<double> stampOf(const nmea::UtcTime &time, const Moment &arrival) {
        constexpr double day = 86400;
        if (!stamp_)
            return std::nullopt;
        const double expected = *stamp_ + double(arrival.mono_ns - mono_ns_) * 1e-9;
        const double ofDay = time.hour * 3600 + time.minute * 60 + time.second;
        if (const auto date = nmea::dateOf(std::round((expected - ofDay) / day) * day))
            set(*date, time, arrival);
        return stamp_;
    }

private:
    std::optional<double> stamp_;
    std::int64_t mono_ns_ = 0; ///< when it arrived
};

} // namespace hermes::seriallogger
