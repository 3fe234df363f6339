#include "protocol/nmea/Fields.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace hermes::nmea {

namespace {

constexpr int maxDecimals = 9;

bool isDigits(std::string_view text) {
    return text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Digits with at most one point, and a sign; nothing else is a number here.
std::optional<double> parseDecimal(std::string_view text, bool mayHaveSign = true) {
    if (mayHaveSign && text.size() > 1 && text[0] == '+' && text[1] != '-')
        text.remove_prefix(1);
    std::string_view digits = text;
    if (mayHaveSign && !digits.empty() && digits[0] == '-')
        digits.remove_prefix(1);
    const std::size_t point = digits.find('.');
    const std::string_view whole = digits.substr(0, point);
    const std::string_view part =
        point == std::string_view::npos ? std::string_view() : digits.substr(point + 1);
    if (whole.size() + part.size() == 0 || !isDigits(whole) || !isDigits(part))
        return std::nullopt;
    double value = 0;
    const auto end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, value, std::chars_format::fixed);
    if (parsed.ec != std::errc() || parsed.ptr != end)
        return std::nullopt;
    return value;
}

bool isCapital(char character) {
    return character >= 'A' && character <= 'Z';
}

int twoDigits(std::string_view text) {
    return (text[0] - '0') * 10 + text[1] - '0';
}

/// Digits before the point; a text that has others gives none.
std::size_t wholeDigits(std::string_view text) {
    const std::size_t whole = std::min(text.find('.'), text.size());
    return isDigits(text.substr(0, whole)) ? whole : 0;
}

} // namespace

void FieldReader::fail(int field, const char *expected) {
    if (!fault_)
        fault_ = {field, expected};
}

std::optional<double> FieldReader::number(int field, double least, double most, const char *expected) {
    const std::string_view text = sentence_.field(field);
    if (text.empty())
        return std::nullopt;
    const std::optional<double> value = parseDecimal(text);
    if (value && *value >= least && *value <= most)
        return value;
    fail(field, expected);
    return std::nullopt;
}

std::optional<int> FieldReader::whole(int field, int least, int most, const char *expected) {
    const std::optional<double> value = number(field, least, most, expected);
    if (!value)
        return std::nullopt;
    if (*value != int(*value))
        fail(field, expected);
    return int(*value);
}

std::optional<char> FieldReader::letter(int field, std::string_view choices, const char *expected) {
    const std::string_view text = sentence_.field(field);
    if (text.empty())
        return std::nullopt;
    if (text.size() == 1 && choices.find(text[0]) != std::string_view::npos)
        return text[0];
    fail(field, expected);
    return std::nullopt;
}

std::optional<UtcTime> FieldReader::time(int field) {
    const std::string_view text = sentence_.field(field);
    if (text.empty())
        return std::nullopt;
    const std::size_t whole = wholeDigits(text);
    if (whole >= 1 && whole <= 6) {
        const std::size_t begin = whole - std::min<std::size_t>(whole, 2);
        char digits[] = "000000"; // some leave out zeros at the beginning
        text.copy(digits + 6 - whole, whole);
        if (const std::optional<double> second = parseDecimal(text.substr(begin), false)) {
            const int decimals = int(text.size() - std::min(whole + 1, text.size()));
            const UtcTime time{twoDigits(digits), twoDigits(digits + 2), *second, decimals};
            if (isValid(time))
                return time;
        }
    }
    fail(field, "a time of day, hhmmss or hhmmss.sss");
    return std::nullopt;
}

std::optional<Date> FieldReader::date(int field) {
    const std::string_view text = sentence_.field(field);
    if (text.empty())
        return std::nullopt;
    if (text.size() == 6 && isDigits(text)) {
        const int year = twoDigits(text.substr(4));
        const Date date{year + (year >= 80 ? 1900 : 2000), twoDigits(text.substr(2)), twoDigits(text)};
        if (isValid(date))
            return date;
    }
    fail(field, "a date, ddmmyy");
    return std::nullopt;
}

std::optional<Position> FieldReader::position(int field) {
    if (sentence_.field(field).empty() && sentence_.field(field + 2).empty())
        return std::nullopt;
    for (int i = 0; i < 4; ++i)
        if (sentence_.field(field + i).empty())
            fail(field, "latitude, N or S, longitude, E or W: all four, or none");
    const auto latitude = angle(field, 2, 90, "NS", "a latitude to 90 degrees, ddmm.mmmm, and N or S");
    const auto longitude =
        angle(field + 2, 3, 180, "EW", "a longitude to 180 degrees, dddmm.mmmm, and E or W");
    if (!latitude || !longitude)
        return std::nullopt;
    return Position{*latitude, *longitude};
}

std::optional<double> FieldReader::angle(int field, int degreeDigits, double most, std::string_view signs,
                                         const char *expected) {
    const std::string_view text = sentence_.field(field);
    const std::optional<char> sign = letter(field + 1, signs, expected);
    const std::size_t whole = wholeDigits(text);
    if (sign && whole >= 1 && whole <= std::size_t(degreeDigits) + 2) {
        const std::size_t split = whole - std::min<std::size_t>(whole, 2); // zeros before it may be missing
        const auto degrees = split > 0 ? parseDecimal(text.substr(0, split), false) : 0.0;
        const auto minutes = parseDecimal(text.substr(split), false);
        if (degrees && minutes && *minutes < 60 && *degrees + *minutes / 60 <= most)
            return (*degrees + *minutes / 60) * (*sign == signs[0] ? 1 : -1);
    }
    fail(field, expected);
    return std::nullopt;
}

FieldWriter::FieldWriter(std::string_view talker, std::string_view type)
    : text_(talker)
    , fits_(talker.size() == 2 && talker[0] != 'P' && isCapital(talker[0]) && isCapital(talker[1])) {
    text_.append(type);
}

void FieldWriter::letter(std::optional<char> value) {
    fits_ = fits_ && (!value || isCapital(*value));
    text_.addField(value && fits_ ? std::string_view(&*value, 1) : std::string_view());
}

void FieldWriter::number(std::optional<double> value, int width, int decimals, double least, double most) {
    if (!value)
        return text_.addField({});
    if (!(*value >= least && *value <= most)) { // NaN too
        fits_ = false;
        return;
    }
    char buffer[64];
    const int size = std::snprintf(buffer, sizeof buffer, "%0*.*f", width, decimals, *value);
    fits_ = fits_ && size > 0 && std::size_t(size) < sizeof buffer;
    if (fits_)
        text_.addField({buffer, std::size_t(size)});
}

void FieldWriter::time(const std::optional<UtcTime> &value, int decimals) {
    if (!value)
        return text_.addField({});
    fits_ = fits_ && isValid(*value) && decimals >= 0 && decimals <= maxDecimals;
    if (!fits_)
        return;
    // Rounding must not reach the next minute.
    const double unit = std::pow(10.0, decimals);
    const double limit = value->second < 60 ? 60 : 61;
    const double second = std::min(std::round(value->second * unit), limit * unit - 1) / unit;
    char buffer[32];
    const int size =
        std::snprintf(buffer, sizeof buffer, "%02u%02u%0*.*f", unsigned(value->hour), unsigned(value->minute),
                      decimals > 0 ? decimals + 3 : 2, decimals, second);
    text_.addField({buffer, std::size_t(size)});
}

void FieldWriter::date(const std::optional<Date> &value) {
    if (!value)
        return text_.addField({});
    fits_ = fits_ && isValid(*value) && value->year >= 1980 && value->year < 2080;
    if (!fits_)
        return;
    char buffer[16];
    const int size = std::snprintf(buffer, sizeof buffer, "%02u%02u%02u", unsigned(value->day) % 100,
                                   unsigned(value->month) % 100, unsigned(value->year) % 100);
    text_.addField({buffer, std::size_t(size)});
}

void FieldWriter::position(const std::optional<Position> &value, int decimals) {
    if (!value) {
        for (int i = 0; i < 4; ++i)
            text_.addField({});
        return;
    }
    angle(value->latitude_deg, 2, 90, decimals, "NS");
    angle(value->longitude_deg, 3, 180, decimals, "EW");
}

void FieldWriter::angle(double value_deg, int degreeDigits, double most, int decimals, const char *signs) {
    fits_ = fits_ && std::abs(value_deg) <= most && decimals >= 0 && decimals <= maxDecimals;
    if (!fits_)
        return;
    // In whole units of the last decimal, so that minutes are never rounded up to 60.
    const double unit = std::pow(10.0, decimals);
    const long long units = std::llround(std::abs(value_deg) * 60 * unit);
    const long long degree = std::llround(60 * unit);
    char buffer[48];
    const int size = std::snprintf(buffer, sizeof buffer, "%0*d%0*.*f", degreeDigits, int(units / degree),
                                   decimals > 0 ? decimals + 3 : 2, decimals, double(units % degree) / unit);
    text_.addField({buffer, std::size_t(size)});
    text_.addField({signs + (value_deg < 0), 1});
}

std::optional<SentenceText> FieldWriter::finish() {
    if (!fits_ || !text_.finish())
        return std::nullopt;
    return text_;
}

} // namespace hermes::nmea
