#pragma once

#include <charconv>
#include <cmath>
#include <ostream>
#include <string_view>

namespace vectorlib {

/// Writes a number with the fewest digits that read back as the same number, whatever the stream's locale and
/// precision: `out << Number(x)`. Never writes "-0".
struct Number {
    double value;
    explicit Number(double v)
        : value(v == 0 ? 0 : v) {}

    friend std::ostream &operator<<(std::ostream &out, Number n) {
        char text[32];
        const auto end = std::to_chars(text, text + sizeof text, n.value).ptr;
        return out.write(text, end - text);
    }
};

/// Writes a number with a fixed count of decimals, for pictures and other places where exactness has no use.
struct Fixed {
    double value;
    int decimals = 2;

    friend std::ostream &operator<<(std::ostream &out, Fixed f) {
        char text[400]; // the largest double has 309 digits before the point
        const auto end =
            std::to_chars(text, text + sizeof text, f.value, std::chars_format::fixed, f.decimals).ptr;
        return out.write(text, end - text);
    }
};

/// A number with so many decimals, where it has more and they mean nothing; Number() writes it shortly then.
/// What was rounded stays as it is.
inline double rounded(double value, int decimals) {
    const double scale = std::pow(10.0, decimals);
    return std::abs(value) * scale < 1e15 ? std::round(value * scale) / scale : value;
}
/// A length, metres, to the micrometre.
inline double micrometres(double length) {
    return rounded(length, 6);
}

} // namespace vectorlib
