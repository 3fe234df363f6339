// What tests of the search of places share.
#pragma once

#include <vectorlib/edges/EdgeRaw2D.h>
#include <vectorlib/geometry/Pose2D.h>

#include <cmath>
#include <vector>

using Walls = std::vector<vectorlib::LineSegment2D<double>>;
using Points = std::vector<vectorlib::Vector2D<float>>;

inline std::vector<vectorlib::MapEdge> mapOf(const Walls &walls) {
    std::vector<vectorlib::MapEdge> slots;
    for (const auto &wall : walls)
        slots.emplace_back(std::int64_t(slots.size()), vectorlib::EdgeRaw2D(vectorlib::TlsSums(), wall, 0.01),
                           1);
    return slots;
}

// A closed room with a niche, its lower left corner at x, y.
inline Walls room(double x, double y) {
    const vectorlib::Vector2D<double> corners[] = {{0, 0}, {5, 0}, {5, 4}, {2, 4}, {2, 3}, {0, 3}};
    Walls walls;
    for (int i = 0; i < 6; ++i) // counter-clockwise: the free space is inside
        walls.emplace_back(corners[i] + vectorlib::Vector2D<double>(x, y),
                           corners[(i + 1) % 6] + vectorlib::Vector2D<double>(x, y));
    return walls;
}

// A cupboard in it, its lower left corner at x, y.
inline void putBox(Walls &walls, double x, double y, double width = 0.9, double depth = 0.6) {
    const vectorlib::Vector2D<double> a(x, y), b(x, y + depth), c(x + width, y + depth), d(x + width, y);
    for (const auto &side : {vectorlib::LineSegment2D<double>(a, b), {b, c}, {c, d}, {d, a}})
        walls.push_back(side);
}

inline bool isNear(const vectorlib::Pose2D &a, const vectorlib::Pose2D &b, double metres = 0.05,
                   double radians = 0.02) {
    return std::hypot(a.x - b.x, a.y - b.y) < metres &&
           std::abs(vectorlib::wrapAngle(a.theta - b.theta)) < radians;
}
