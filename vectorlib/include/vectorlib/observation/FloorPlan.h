#pragma once

#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/observation/Ray.h"

#include <algorithm>
#include <random>
#include <vector>

namespace vectorlib {

/// Floor plans at random: rooms on both sides of a corridor, each with a door and one to four pieces of
/// furniture; metres. The same seed gives the same plan on every machine.
class FloorPlan {
public:
    using Wall = LineSegment2D<double>;
    using Point = Vector2D<double>;

    /// How the rooms of a plan differ.
    enum class Rooms {
        Different, ///< of different sizes
        Alike      ///< told apart by their furniture alone
    };

    /// A plan with so many rooms.
    FloorPlan(unsigned seed, int rooms, Rooms kind = Rooms::Different)
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
    const std::vector<Wall> &walls() const { return walls_; }
    /// The same building later: so large a share of the furniture, drawn by a seed, was moved within its
    /// room, was taken away, or has got another piece beside it.
    FloorPlan refurnished(unsigned seed, double share) const {
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
    /// A place at random, as placeAmong.
    Pose2D place() { return placeAmong(walls_, random_); }
    /// A place at random, 30 cm from every wall, from where all walls around show their free side. There must
    /// be such places. With `isOpen` there may be no wall in some directions.
    static Pose2D placeAmong(const std::vector<Wall> &walls, std::mt19937 &random, bool isOpen = false) {
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

private:
    static constexpr double thickness = 0.1;
    struct Room {
        double x, y, side, width, depth, door, gap; ///< of the room's corner at the corridor
    };
    struct Piece {
        Room room;
        std::size_t firstWall; ///< of four
    };

    static double between(std::mt19937 &random, double a, double b) {
        return a + (b - a) * double(random() % 100001) / 100000;
    }
    double between(double a, double b) { return between(random_, a, b); }
    // An outline with the free space outside.
    void block(double x0, double y0, double x1, double y1) {
        const double left = std::min(x0, x1), right = std::max(x0, x1), low = std::min(y0, y1),
                     high = std::max(y0, y1);
        const Point a(left, low), b(left, high), c(right, high), d(right, low);
        for (const Wall &wall : {Wall(a, b), Wall(b, c), Wall(c, d), Wall(d, a)})
            walls_.push_back(wall);
    }
    // Rooms that begin at a height y and lie above (side 1) or below it (-1); gives where the last one ends.
    double row(int rooms, double y, double side) {
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
    void furnish(const Room &room) {
        const double a = between(0.3, 1.2), b = between(0.3, 0.9);
        const double at = between(room.x + 0.2, room.x + room.width - a - 0.2);
        const double deep = between(0.9, room.depth - b - 0.1);
        block(at, room.y + room.side * deep, at + a, room.y + room.side * (deep + b));
    }
    static bool isFree(const std::vector<Wall> &walls, Point p, bool isOpen) {
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

    std::mt19937 random_;
    Rooms kind_;
    std::vector<Wall> walls_;
    std::vector<Piece> pieces_; // of furniture
};

} // namespace vectorlib
