#pragma once

#include "protocol/nmea/Sentence.h"
#include "protocol/nmea/UtcTime.h"

#include <optional>

namespace hermes::nmea {

/// Where on the Earth (WGS 84); degrees, north and east positive, at most 90 and 180.
struct Position {
    double latitude_deg = 0;
    double longitude_deg = 0;
};

constexpr double knot = 1852.0 / 3600; ///< m/s
constexpr double maxKnots = 9999;      ///< of a speed
constexpr double maxMetres = 1e6;      ///< of an altitude
constexpr double maxHdop = 9999;       ///< some write 99.99 or 9999 for none
constexpr int maxSatellites = 999;

/// What is wrong with a sentence; false when nothing is.
struct FieldFault {
    int field = 0; ///< which, from 1; 0: their number or the address
    const char *expected = nullptr;

    explicit operator bool() const { return expected != nullptr; }
};

/// Decimals that an encoder writes.
struct Decimals {
    int minutes = 4; ///< of latitude and longitude; 4 are 0.19 m
    int seconds = 0; ///< of the time
};

/// Reads fields one after the other; the first that is wrong stays in fault(). An empty field reads as
/// nothing, which is no fault.
class FieldReader {
public:
    explicit FieldReader(const Sentence &sentence)
        : sentence_(sentence) {}

    const FieldFault &fault() const { return fault_; }
    void fail(int field, const char *expected);

    /// A decimal number within the limits, also with a sign. Exponents, infinity and NaN are no such numbers.
    std::optional<double> number(int field, double least, double most, const char *expected);
    /// One without decimals.
    std::optional<int> whole(int field, int least, int most, const char *expected);
    /// One of the characters of choices.
    std::optional<char> letter(int field, std::string_view choices, const char *expected);
    /// hhmmss with any decimals; zeros at its beginning may be missing.
    std::optional<UtcTime> time(int field);
    /// ddmmyy; years from 80 on are of the 20th century.
    std::optional<Date> date(int field);
    /// Four fields: ddmm.mmmm, N or S, dddmm.mmmm, E or W. All of them, or none; receivers without a fix
    /// leave the letters. The two digits before a point are minutes: zeros at the beginning may be missing.
    std::optional<Position> position(int field);

private:
    std::optional<double> angle(int field, int degreeDigits, double most, std::string_view signs,
                                const char *expected);

    const Sentence &sentence_;
    FieldFault fault_;
};

/// Writes fields one after the other; nothing becomes an empty field. What does not fit a field makes
/// finish() give nothing.
class FieldWriter {
public:
    /// talker: two capital letters, not P; type: "RMC".
    FieldWriter(std::string_view talker, std::string_view type);

    void letter(std::optional<char> value);
    /// With that many decimals, filled up with zeros to width.
    void number(std::optional<double> value, int width, int decimals, double least, double most);
    void time(const std::optional<UtcTime> &value, int decimals);
    void date(const std::optional<Date> &value);
    void position(const std::optional<Position> &value, int decimals);

    std::optional<SentenceText> finish();

private:
    void angle(double value_deg, int width, double most, int decimals, const char *signs);

    SentenceText text_;
    bool fits_ = true;
};

} // namespace hermes::nmea
