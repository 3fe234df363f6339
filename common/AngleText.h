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

/// "90 rad is 14.3 turns; did you mean 1.571 rad (90 degrees)?", asked only of whole numbers, which are
/// likely degrees.
inline std::string beyondTurnText(double angle) {
    const auto number = [](double value, int digits) {
        std::ostringstream text;
        text.precision(digits);
        text << value;
        return text.str();
    };
    const double turns = std::abs(angle) / (2 * vectorlib::pi);
    const std::string text = number(angle, 6) + " rad is " + number(turns, turns < 1.1 ? 5 : 3) + " turns";
    if (angle != std::round(angle) || std::abs(angle) > 360)
        return text + ", expected is one at most";
    return text + "; did you mean " + number(angle * vectorlib::pi / 180, 4) + " rad (" + number(angle, 6) +
           " degrees)?";
}

} // namespace hermes
