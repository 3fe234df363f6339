#pragma once

#include "tests/vectorlib/ScanWorld.h"

/// Worlds in which much looks alike, drawn at random: what stands in rows of equal pitch, and plain rooms.
/// Metres. The same state of the generator gives the same world.
class RepeatingWorlds {
public:
    enum Kind {
        Desks,
        Niches,
        Rooms,
        Doors,
        Shelves,
        Pillars,
        Offices,
        CarPark,
        Round,
        HalfTurn,
        EqualRooms
    };
    static constexpr const char *names[] = {"desks",   "niches",    "rooms",      "doors",
                                            "shelves", "pillars",   "offices",    "car park",
                                            "round",   "half turn", "equal rooms"};

    /// What two scans of a world show, and how the second one was moved.
    struct Pair {
        ScanWorld::Points fixed, moving;
        vectorlib::Transformation2D motion;
        ScanWorld::Scanner scanner;
    };

    explicit RepeatingWorlds(std::mt19937 &random)
        : random_(random) {}

    /// Two scans of a new world of that kind, by a new scanner.
    Pair draw(Kind kind) {
        world_ = ScanWorld();
        build(kind);
        const double turns[] = {0.5, 0.75, 1};
        const int rays[] = {181, 361, 541, 720};
        const bool half = any(2) == 0;
        const ScanWorld::Scanner scanner{rays[any(4)], 2 * vectorlib::pi * turns[half ? 0 : 1 + any(2)],
                                         between(0.01, 0.03), between(8, 30)};
        for (;;) {
            const vectorlib::Transformation2D from(between(low_.x, high_.x), between(low_.y, high_.y),
                                                   angle());
            const double far = between(0, 2), way = angle();
            const double most = half ? 0.5 : 1; // of a turn, else the views share nothing
            const vectorlib::Transformation2D motion(far * std::cos(way), far * std::sin(way),
                                                     most * angle());
            const vectorlib::Transformation2D to = from * motion;
            if (isFree(from.translation()) && isFree(to.translation()))
                return {world_.scan(from, random_, scanner), world_.scan(to, random_, scanner), motion,
                        scanner};
        }
    }

private:
    using Point = ScanWorld::Point;

    double between(double a, double b) { return a + (b - a) * double(random_() % 100001) / 100000; }
    double angle() { return between(-vectorlib::pi, vectorlib::pi); }
    int any(unsigned count) { return int(random_() % count); }

    void build(Kind kind) {
        switch (kind) {
        case Desks:
            return rows(between(1, 1.6), between(0.6, 0.9), between(0.5, 1.2), between(1, 1.8));
        case Shelves:
            return rows(between(3, 6), between(0.4, 0.8), between(1, 2), between(1.2, 2));
        case Offices:
            return offices();
        case Niches:
            return corridor(between(0.2, 0.6));
        case Doors:
            return corridor(between(0.05, 0.12));
        case Rooms:
            return furnishedRoom();
        case Pillars:
            return roundHall();
        case CarPark:
            return rows(between(0.3, 0.6), between(0.3, 0.6), between(2, 4), between(2, 4));
        case Round:
            return roundWall(between(3, 7), 6 + any(15));
        case HalfTurn:
            return sameAfterHalfATurn();
        case EqualRooms:
            return equalRooms();
        }
    }
    void hall(double width, double depth) {
        low_ = {0, 0};
        high_ = {width, depth};
        const Point corners[] = {{0, 0}, {width, 0}, {width, depth}, {0, depth}};
        for (int i = 0; i < 4; ++i)
            world_.walls.emplace_back(corners[i], corners[(i + 1) % 4]);
    }
    void box(double x, double y, double width, double depth, double turn = 0) {
        const vectorlib::Transformation2D place(x, y, turn);
        const Point corners[] = {{0, 0}, {width, 0}, {width, depth}, {0, depth}};
        for (int i = 0; i < 4; ++i)
            world_.walls.emplace_back(place * corners[i], place * corners[(i + 1) % 4]);
    }
    // Boxes of equal pitch in a hall.
    void rows(double width, double depth, double gapX, double gapY) {
        const int columns = 3 + any(5), lines = 3 + any(4);
        const double border = between(0.8, 3);
        hall(columns * (width + gapX) - gapX + 2 * border, lines * (depth + gapY) - gapY + 2 * border);
        for (int i = 0; i < columns; ++i)
            for (int k = 0; k < lines; ++k)
                box(border + i * (width + gapX), border + k * (depth + gapY), width, depth);
    }
    // Cells with walls on three sides on both sides of an aisle, some with a cupboard.
    void offices() {
        const double width = between(2, 3.5), depth = between(2, 3.5), aisle = between(1.5, 3);
        const int cells = 4 + any(6);
        hall(cells * width, 2 * depth + aisle);
        for (int i = 0; i < cells; ++i)
            for (const double side : {0.0, depth + aisle}) {
                if (i > 0)
                    box(i * width - 0.03, side, 0.06, depth);
                if (any(3) == 0)
                    box(i * width + between(0.2, width - 1), side + (side > 0 ? depth - 0.5 : 0),
                        between(0.4, 0.8), 0.5);
                box(i * width + 0.3, side + (side > 0 ? 0.6 : depth - 1.2), width - 1.2, 0.6);
            }
    }
    // With recesses of equal pitch on one side or both; longer than is seen, or ending in sight.
    void corridor(double recess) {
        const double width = between(1.6, 3), pitch = between(1.5, 4), gap = between(0.8, 1.2);
        const double length = any(2) == 0 ? 80 : between(12, 30);
        const bool bothSides = any(2) == 0;
        std::vector<Point> corners{{0, 0}};
        for (double x = pitch / 2; x + gap < length; x += pitch)
            corners.insert(corners.end(), {{x, 0}, {x, -recess}, {x + gap, -recess}, {x + gap, 0}});
        corners.insert(corners.end(), {{length, 0}, {length, width}});
        const double offset = between(0, pitch);
        if (bothSides)
            for (double x = length - pitch / 2 - offset; x - gap > 0; x -= pitch)
                corners.insert(
                    corners.end(),
                    {{x, width}, {x, width + recess}, {x - gap, width + recess}, {x - gap, width}});
        corners.push_back({0, width});
        world_ = ScanWorld::of(corners);
        low_ = {1, 0};
        high_ = {length - 1, width};
    }
    void furnishedRoom() {
        hall(between(4, 9), between(3, 7));
        const double width = high_.x, depth = high_.y;
        for (int boxes = any(7); boxes > 0; --boxes)
            box(between(0.3, width - 1.2), between(0.3, depth - 1), between(0.3, 0.9), between(0.3, 0.7),
                any(2) == 0 ? 0 : between(0, 0.5));
    }
    void roundHall() {
        const double radius = between(5, 10), ring = between(2, radius - 1.2), size = between(0.15, 0.4);
        const int pillars = 5 + any(10);
        roundWall(radius, 90);
        for (int i = 0; i < pillars; ++i)
            world_.pillars.push_back({onCircle(ring, i, pillars), size});
    }
    void roundWall(double radius, int corners) {
        for (int i = 0; i < corners; ++i)
            world_.walls.emplace_back(onCircle(radius, i, corners), onCircle(radius, i + 1, corners));
        low_ = {-radius, -radius};
        high_ = {radius, radius};
    }
    // A hall with two boxes.
    void sameAfterHalfATurn() {
        hall(between(5, 10), between(4, 8));
        const double width = between(0.3, 0.7), depth = between(0.3, 0.7);
        const double x = high_.x / 2 + between(0.3, high_.x / 2 - 1), y = between(0.3, high_.y - 1);
        box(x, y, width, depth);
        box(high_.x - x - width, high_.y - y - depth, width, depth);
    }
    // Along a corridor, with a door each.
    void equalRooms() {
        const double step = between(3, 5), depth = between(3, 5), width = between(1.6, 2.5),
                     gap = between(0.8, 1.1), door = between(0.4, 1.5), inner = width + 0.1;
        const int count = 4 + any(4);
        std::vector<Point> corners{{0, 0}, {count * step, 0}, {count * step, width}};
        for (double x = (count - 1) * step; x > -0.5 * step; x -= step)
            corners.insert(corners.end(), {{x + door + gap, width},
                                           {x + door + gap, inner},
                                           {x + step - 0.1, inner},
                                           {x + step - 0.1, width + depth},
                                           {x, width + depth},
                                           {x, inner},
                                           {x + door, inner},
                                           {x + door, width}});
        corners.push_back({0, width});
        world_ = ScanWorld::of(corners);
        low_ = {0, 0};
        high_ = {count * step, width + depth};
    }
    static Point onCircle(double radius, int i, int count) {
        const double a = 2 * vectorlib::pi * i / count;
        return {radius * std::cos(a), radius * std::sin(a)};
    }

    bool isFree(Point p) const {
        constexpr double least = 0.3;
        for (const auto &wall : world_.walls)
            if (wall.distance(p) < least)
                return false;
        for (const auto &pillar : world_.pillars)
            if ((p - pillar.centre).norm() < pillar.radius + least)
                return false;
        return isInside(p);
    }
    // In the hall and in no box: an odd number of walls lies to the right.
    bool isInside(Point p) const {
        int right = 0;
        for (const auto &wall : world_.walls) {
            const Point a = wall.begin(), b = wall.end();
            if ((a.y > p.y) != (b.y > p.y) && a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y) > p.x)
                ++right;
        }
        return right % 2 == 1;
    }

    std::mt19937 &random_;
    ScanWorld world_;
    Point low_, high_; // where a scanner may stand
};
