#pragma once

#include "vectorlib/geometry/LineSegment2D.h"

#include <string>
#include <vector>

namespace hermes::vector {

/// A number as line segments, seven to a digit, for pictures that know no text: its lower left corner, and
/// the height of a digit, which is twice as high as wide.
inline std::vector<vectorlib::LineSegment2D<double>>
drawnNumber(std::size_t number, vectorlib::Vector2D<double> corner, double height) {
    using Point = vectorlib::Vector2D<double>;
    // Ends of the seven strokes, in half heights, and which of them each digit has.
    static const Point strokes[7][2] = {{{0, 2}, {1, 2}}, {{1, 2}, {1, 1}}, {{1, 1}, {1, 0}},
                                        {{0, 0}, {1, 0}}, {{0, 0}, {0, 1}}, {{0, 1}, {0, 2}},
                                        {{0, 1}, {1, 1}}};
    constexpr unsigned digits[10] = {0x3f, 0x06, 0x5b, 0x4f, 0x66, 0x6d, 0x7d, 0x07, 0x7f, 0x6f};
    std::vector<vectorlib::LineSegment2D<double>> result;
    for (const char digit : std::to_string(number)) {
        for (unsigned i = 0; i < 7; ++i)
            if (digits[digit - '0'] >> i & 1u)
                result.emplace_back(corner + strokes[i][0] * (height / 2),
                                    corner + strokes[i][1] * (height / 2));
        corner.x += 0.75 * height;
    }
    return result;
}

} // namespace hermes::vector
