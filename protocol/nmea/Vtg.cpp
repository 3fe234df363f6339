#include "protocol/nmea/Vtg.h"

namespace hermes::nmea {

namespace {

constexpr int leastFields = 8;  // up to the unit of the second speed
constexpr double kmh = 1 / 3.6; // m/s

/// A number and the letter of its unit; the letter alone is nothing.
std::optional<double> withUnit(FieldReader &read, int field, double most, std::string_view unit,
                               const char *expected) {
    const std::optional<double> value = read.number(field, 0, most, expected);
    if (value && !read.letter(field + 1, unit, expected))
        read.fail(field + 1, expected);
    return value;
}

} // namespace

FieldFault decode(const Sentence &sentence, Vtg &vtg) {
    if (sentence.type() != "VTG" || sentence.fieldCount() < leastFields)
        return {0, "VTG with 8 fields or more"};
    FieldReader read(sentence);
    vtg = Vtg();
    vtg.course_deg = withUnit(read, 1, 360, "T", "a course from 0 to 360 degrees, and T");
    if (const auto knots = withUnit(read, 5, mostKnots, "N", "a speed from 0 to 9999 knots, and N"))
        vtg.speed = *knots * knot;
    else if (const auto other = withUnit(read, 7, mostKnots * 2, "K", "a speed in km/h, and K"))
        vtg.speed = *other * kmh;
    return read.fault();
}

} // namespace hermes::nmea
