#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Vector2D.h"

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
    FloorPlan(unsigned seed, int rooms, Rooms kind = Rooms::Different);
    const std::vector<Wall> &walls() const { return walls_; }
    /// The same building later: so large a share of the furniture, drawn by a seed, was moved within its
    /// room, was taken away, or has got another piece beside it.
    FloorPlan refurnished(unsigned seed, double share) const;
    /// A place at random, as placeAmong.
    Pose2D place() { return placeAmong(walls_, random_); }
    /// A place at random, 30 cm from every wall, from where all walls around show their free side. There must
    /// be such places. With `isOpen` there may be no wall in some directions.
    static Pose2D placeAmong(const std::vector<Wall> &walls, std::mt19937 &random, bool isOpen = false);

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
    void block(double x0, double y0, double x1, double y1);
    // Rooms that begin at a height y and lie above (side 1) or below it (-1); gives where the last one ends.
    double row(int rooms, double y, double side);
    void furnish(const Room &room);
    static bool isFree(const std::vector<Wall> &walls, Point p, bool isOpen);

    std::mt19937 random_;
    Rooms kind_;
    std::vector<Wall> walls_;
    std::vector<Piece> pieces_; // of furniture
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/observation/FloorPlan.cpp")
