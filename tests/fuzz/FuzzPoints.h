#pragma once

#include "tests/fuzz/FuzzInput.h"

#include <vectorlib/geometry/Vector2D.h>

#include <vector>

/// The rest of the input as at most `most` points: raw numbers of any kind, millimetres near the origin,
/// millimetres from point to point, or ranges at even angles.
template <typename Scalar>
std::vector<vectorlib::Vector2D<Scalar>> takePoints(FuzzInput &in, std::size_t most) {
    using Point = vectorlib::Vector2D<Scalar>;
    std::vector<Point> points;
    const int kind = in.take<std::uint8_t>() % 4;
    Point walk;
    while (in.left() > 0 && points.size() < most) {
        if (kind == 0) {
            const auto x = in.take<Scalar>(), y = in.take<Scalar>();
            points.emplace_back(x, y);
        } else if (kind == 3) {
            const double range = in.take<std::uint16_t>() * 0.002, angle = 0.01 * double(points.size());
            points.emplace_back(Scalar(range * std::cos(angle)), Scalar(range * std::sin(angle)));
        } else if (kind == 1) {
            const auto x = in.take<std::int16_t>(), y = in.take<std::int16_t>();
            points.emplace_back(Scalar(x) / 1000, Scalar(y) / 1000);
        } else {
            const auto x = in.take<std::int8_t>(), y = in.take<std::int8_t>();
            points.push_back(walk += Point(Scalar(x) / 1000, Scalar(y) / 1000));
        }
    }
    return points;
}
