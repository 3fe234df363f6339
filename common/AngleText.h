#pragma once

#include "vectorlib/geometry/Angle.h"

#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

namespace hermes {

/// The radians of an angle that a person types: radians, or degrees as "90deg". `parseNumber` reads the
/// number.
template <typename ParseNumber>
std::optional<double> parseAngle(std::string_view text, const ParseNumber &parseNumber) {
    constexpr std::string_view unit = "deg";
    const bool inDegrees = text.size() > unit.size() && text.substr(text.size() - unit.size()) == unit;
    text.remove_suffix(inDegrees ? unit.size() : 0);
    const std::optional<double> number = parseNumber(text);
    return number && inDegrees ? *number * vectorlib::pi / 180 : number;
}

/// Whether an angle in radians is beyond a full turn: most often it was meant in degrees.
inline bool isBeyondTurn(double angle) {
    return std::abs(angle) > 2 * vectorlib::pi;
}

/// "90 rad is 14.3 turns; did you mean 1.571 rad (90 degrees)?"
inline std::string beyondTurnText(double angle) {
    std::ostringstream text;
    text.precision(3);
    text << std::abs(angle) / (2 * vectorlib::pi);
    const std::string turns = text.str();
    text.str({});
    text.precision(4);
    text << angle * vectorlib::pi / 180;
    const std::string meant = text.str();
    text.str({});
    text.precision(6);
    text << angle;
    return text.str() + " rad is " + turns + " turns; did you mean " + meant + " rad (" + text.str() +
           " degrees)?";
}

} // namespace hermes
