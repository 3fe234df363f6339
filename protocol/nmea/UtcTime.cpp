#include "protocol/nmea/UtcTime.h"

#include <cmath>

namespace hermes::nmea {

namespace {

constexpr double secondsOfDay = 86400;
constexpr double lastStamp = 253402300800; // 10000-01-01

bool isLeap(int year) {
    return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
}

int daysOfMonth(int year, int month) {
    constexpr int days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    return days[month - 1] + (month == 2 && isLeap(year));
}

int daysBeforeYear(int year) { // since 1970-01-01
    const int last = year - 1;
    return 365 * (year - 1970) + (last / 4 - 1969 / 4) - (last / 100 - 1969 / 100) +
           (last / 400 - 1969 / 400);
}

bool isStamp(double stamp) {
    return stamp >= 0 && stamp < lastStamp; // false for NaN
}

} // namespace

bool isValid(const UtcTime &time) {
    return time.hour >= 0 && time.hour < 24 && time.minute >= 0 && time.minute < 60 && time.second >= 0 &&
           time.second < 61;
}

bool isValid(const Date &date) {
    return date.year >= 1970 && date.year <= 9999 && date.month >= 1 && date.month <= 12 && date.day >= 1 &&
           date.day <= daysOfMonth(date.year, date.month);
}

std::optional<double> toStamp(const Date &date, const UtcTime &time) {
    if (!isValid(date) || !isValid(time))
        return std::nullopt;
    int days = daysBeforeYear(date.year) + date.day - 1;
    for (int month = 1; month < date.month; ++month)
        days += daysOfMonth(date.year, month);
    return days * secondsOfDay + time.hour * 3600 + time.minute * 60 + time.second;
}

bool isRolledOver(double told, double clock) {
    constexpr double weeks = 1024 * 7 * secondsOfDay, alike = 2 * secondsOfDay;
    const double periods = std::round((clock - told) / weeks);
    return periods != 0 && std::abs(clock - told - periods * weeks) < alike;
}

std::optional<UtcTime> timeOf(double stamp) {
    if (!isStamp(stamp))
        return std::nullopt;
    const double ofDay = std::fmod(stamp, secondsOfDay);
    const int minutes = int(ofDay / 60);
    return UtcTime{minutes / 60, minutes % 60, ofDay - minutes * 60};
}

std::optional<Date> dateOf(double stamp) {
    if (!isStamp(stamp))
        return std::nullopt;
    int days = int(stamp / secondsOfDay);
    Date date;
    date.year = 1970 + days / 366; // never too late
    while (daysBeforeYear(date.year + 1) <= days)
        ++date.year;
    days -= daysBeforeYear(date.year);
    while (days >= daysOfMonth(date.year, date.month))
        days -= daysOfMonth(date.year, date.month++);
    date.day = days + 1;
    return date;
}

} // namespace hermes::nmea
