#include "vectorlib/observation/FloorPlan.h"

#include "vectorlib/observation/Observer.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY FloorPlan::FloorPlan(unsigned seed, int rooms, Rooms kind)
    : random_(seed)
    , kind_(kind) {
    const double corridor = between(1.6, 2.6);
    const double left = row(rooms / 2, corridor, 1), right = row(rooms / 2, 0, -1);
    const double end = std::max(left, right);
    block(-thickness, -thickness, 0, corridor + thickness);
    block(end, -thickness, end + thickness, corridor + thickness);
    if (left < end)
        block(left, corridor, end, corridor + thickness);
    if (right < end)
        block(right, -thickness, end, 0);
}

VECTORLIB_BODY FloorPlan FloorPlan::refurnished(unsigned seed, double share) const {
    FloorPlan later = *this;
    later.random_.seed(seed);
    for (std::size_t i = pieces_.size(); i-- > 0;) {
        if (later.between(0, 1) >= share)
            continue;
        const double kind = later.between(0, 1);
        if (kind < 0.75) { // moved, or taken away
            const auto begin = later.walls_.begin() + std::ptrdiff_t(pieces_[i].firstWall);
            later.walls_.erase(begin, begin + 4);
        }
        if (kind < 0.5 || kind >= 0.75)
            later.furnish(pieces_[i].room);
    }
    later.pieces_.clear(); // its walls have other numbers now
    return later;
}

VECTORLIB_BODY Pose2D FloorPlan::placeAmong(const std::vector<Wall> &walls, std::mt19937 &random,
                                            bool isOpen) {
    Point low(1e9, 1e9), high(-1e9, -1e9);
    for (const Wall &w : walls)
        for (const Point p : {w.begin(), w.end()}) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
    for (;;) {
        const double y = between(random, low.y, high.y), x = between(random, low.x, high.x);
        if (isFree(walls, {x, y}, isOpen))
            return {x, y, between(random, -pi, pi)};
    }
}

VECTORLIB_BODY void FloorPlan::block(double x0, double y0, double x1, double y1) {
    const double left = std::min(x0, x1), right = std::max(x0, x1), low = std::min(y0, y1),
                 high = std::max(y0, y1);
    const Point a(left, low), b(left, high), c(right, high), d(right, low);
    for (const Wall &wall : {Wall(a, b), Wall(b, c), Wall(c, d), Wall(d, a)})
        walls_.push_back(wall);
}

VECTORLIB_BODY double FloorPlan::row(int rooms, double y, double side) {
    const double depth = between(3.5, 6.5);
    Room room{0, y, side, 0, 0, 0, 0};
    for (int number = 0; number < rooms; ++number) {
        if (number == 0 || kind_ == Rooms::Different) {
            room.width = between(2.5, 6.5);
            room.door = between(0.3, room.width - 1.3);
            room.gap = between(0.8, 1.0);
            room.depth = depth - between(0, 0.8);
        }
        const double x = room.x, right = x + room.width;
        block(x, y, x + room.door, y + side * thickness);
        block(x + room.door + room.gap, y, right, y + side * thickness);
        block(x - thickness / 2, y + side * thickness, x + thickness / 2, y + side * depth);
        block(x + thickness / 2, y + side * room.depth, right - thickness / 2,
              y + side * (room.depth + thickness));
        for (int pieces = 1 + int(random_() % 4); pieces > 0; --pieces) {
            pieces_.push_back({room, walls_.size()});
            furnish(room);
        }
        room.x = right;
    }
    const double x = room.x;
    block(x - thickness / 2, y + side * thickness, x + thickness / 2, y + side * depth);
    return x;
}

VECTORLIB_BODY void FloorPlan::furnish(const Room &room) {
    const double a = between(0.3, 1.2), b = between(0.3, 0.9);
    const double at = between(room.x + 0.2, room.x + room.width - a - 0.2);
    const double deep = between(0.9, room.depth - b - 0.1);
    block(at, room.y + room.side * deep, at + a, room.y + room.side * (deep + b));
}

VECTORLIB_BODY bool FloorPlan::isFree(const std::vector<Wall> &walls, Point p, bool isOpen) {
    for (const Wall &w : walls)
        if (w.distance(p) < 0.3)
            return false;
    for (int k = 0; k < 16; ++k) {
        const double angle = k * pi / 8 + 0.01;
        double nearest = 1e9;
        bool showsFront = isOpen;
        for (const Wall &w : walls) {
            const double t = rayDistance({std::cos(angle), std::sin(angle)}, w.begin() - p, w.end() - p);
            if (t < nearest) {
                nearest = t;
                showsFront = w.across(p) > 0;
            }
        }
        if (!showsFront)
            return false;
    }
    return true;
}

} // namespace vectorlib
