#include "protocol/nmea/Vtg.h"

namespace hermes::nmea {

namespace {

constexpr double kmh = 1 / 3.6; // m/s

/// A number with the letter of its unit; anything else is nothing.
std::optional<double> withUnit(const Sentence &sentence, int field, double most, std::string_view unit) {
    FieldReader read(sentence);
    const std::optional<double> value = read.number(field, 0, most, "");
    return sentence.field(field + 1) == unit ? value : std::nullopt;
}

} // namespace

FieldFault decode(const Sentence &sentence, Vtg &vtg) {
    if (!sentence.is("VTG", 8)) // up to the unit of the second speed
        return {0, "VTG with 8 fields or more"};
    vtg = Vtg();
    vtg.course_deg = withUnit(sentence, 1, 360, "T");
    if (const auto knots = withUnit(sentence, 5, maxKnots, "N"))
        vtg.speed = *knots * knot;
    else if (const auto other = withUnit(sentence, 7, maxKnots * 2, "K"))
        vtg.speed = *other * kmh;
    return {};
}

} // namespace hermes::nmea
