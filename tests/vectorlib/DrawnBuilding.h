#pragma once

#include "tests/vectorlib/DriveWay.h"
#include "tests/vectorlib/ScanWorld.h"

/// What buildings share that are drawn at random: walls, and doors through which a drive visits rooms.
class DrawnBuilding {
public:
    using Point = ScanWorld::Point;

    ScanWorld world;

protected:
    struct Door {
        Point before, inside; // in the middle of the corridor, and in the room
    };

    explicit DrawnBuilding(std::mt19937 &random)
        : random_(random) {}

    double between(double a, double b) { return a + (b - a) * double(random_() % 100001) / 100000; }
    int any(unsigned count) { return int(random_() % count); }
    void wall(Point from, Point to) { world.walls.emplace_back(from, to); }
    void box(Point low, Point high) {
        wall(low, {high.x, low.y});
        wall({high.x, low.y}, high);
        wall(high, {low.x, high.y});
        wall({low.x, high.y}, low);
    }
    static void visit(const Door &door, DriveWay &way) {
        for (const Point &place : {door.before, door.inside, door.before})
            way.goTo(place);
    }

    std::mt19937 &random_;
};
