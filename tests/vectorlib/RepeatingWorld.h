#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

/// Worlds at random in which things repeat, and two places in the free space of each; metres. The same seed
/// gives the same world.
class RepeatingWorld {
public:
    using Point = vectorlib::Vector2D<double>;
    using Segment = vectorlib::LineSegment2D<double>;
    enum Kind { Desks, Pillars, Round, Niches, Rectangle, HalfTurn, Rooms };

    std::vector<Segment> edges;
    vectorlib::Pose2D first, second; ///< of any heading

    /// The places lie apart by no more than the reach in x and in y.
    RepeatingWorld(Kind kind, std::uint64_t seed, double reach)
        : random_(seed * 7919 + kind) {
        draw(kind);
        do
            first = place(0, 0, 15);
        while (!isFree({first.x, first.y}));
        do
            second = place(first.x, first.y, reach);
        while (!isFree({second.x, second.y}));
    }

private:
    double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
    int oneOf(int least, int most) { return least + int(random_() % unsigned(most - least + 1)); }
    void close(const std::vector<Point> &corners) {
        for (std::size_t i = 0; i < corners.size(); ++i)
            edges.emplace_back(corners[i], corners[(i + 1) % corners.size()]);
    }
    // Free space inside.
    void room(double x0, double y0, double x1, double y1) { close({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}); }
    // Free space outside.
    void block(double x, double y, double width, double depth) {
        close({{x, y}, {x, y + depth}, {x + width, y + depth}, {x + width, y}});
    }
    // side 1: free space inside, -1: outside.
    void polygon(Point middle, double radius, int corners, double start, int side) {
        std::vector<Point> outline;
        for (int i = 0; i < corners; ++i) {
            const double angle = start + side * 2 * vectorlib::pi * i / corners;
            outline.push_back(middle + Point(std::cos(angle), std::sin(angle)) * radius);
        }
        close(outline);
    }
    void draw(Kind kind) {
        switch (kind) {
        case Desks:
            return drawDesks();
        case Pillars:
            return drawPillars();
        case Round:
            return polygon({}, between(3, 7), oneOf(6, 20), between(0, 1), 1);
        case Niches:
            return drawNiches();
        case Rectangle:
            return room(-between(2, 5), -between(1.5, 3.5), between(2, 5), between(1.5, 3.5));
        case HalfTurn:
            return drawHalfTurn();
        case Rooms:
            return drawRooms();
        }
    }
    // Rows of equal desks in a room.
    void drawDesks() {
        const int columns = oneOf(2, 5), rows = oneOf(2, 4);
        const double stepX = between(1.6, 2.6), stepY = between(1.6, 2.6), width = between(0.6, 1.2),
                     depth = between(0.5, 0.9), x = between(0.5, 1.5), y = between(0.5, 1.5);
        room(0, 0, x + columns * stepX + between(0, 1), y + rows * stepY + between(0, 1));
        for (int i = 0; i < columns; ++i)
            for (int j = 0; j < rows; ++j)
                block(x + i * stepX, y + j * stepY, width, depth);
    }
    // A ring of equal pillars in a round room.
    void drawPillars() {
        const int count = oneOf(5, 10), corners = 2 * oneOf(2, 3);
        const double radius = between(5, 8);
        polygon({}, radius, 3 * count, between(0, 1), 1);
        for (int i = 0; i < count; ++i) {
            const double angle = 2 * vectorlib::pi * i / count;
            polygon(Point(std::cos(angle), std::sin(angle)) * (0.6 * radius), 0.35, corners, angle, -1);
        }
    }
    // A corridor with niches at even steps on one side or both.
    void drawNiches() {
        const double step = between(1.8, 4), width = between(1.6, 3), depth = between(0.3, 1.2),
                     gap = between(0.8, 1.2);
        const int count = oneOf(5, 10);
        const double end = 0.5 + count * step + between(0, 0.5);
        std::vector<Point> outline{{0, 0}};
        const auto niche = [&](double x, double y, double side) {
            for (const Point p : {Point(x, y), Point(x, y - side * depth),
                                  Point(x + side * gap, y - side * depth), Point(x + side * gap, y)})
                outline.push_back(p);
        };
        const bool onBoth = oneOf(0, 1) > 0;
        for (int i = 0; onBoth && i < count; ++i)
            niche(0.5 + i * step, 0, 1);
        outline.emplace_back(end, 0);
        outline.emplace_back(end, width);
        for (int i = count; i-- > 0;)
            niche(0.5 + i * step + gap, width, -1);
        outline.emplace_back(0, width);
        close(outline);
    }
    // A room and a block in it that look the same after half a turn.
    void drawHalfTurn() {
        const double x = between(2.5, 5), y = between(2, 4), width = between(0.3, 0.7),
                     depth = between(0.3, 0.7);
        room(-x, -y, x, y);
        const double left = between(0.3, x - 1), low = between(-y + 0.3, y - 1);
        block(left, low, width, depth);
        block(-left - width, -low - depth, width, depth);
    }
    // Equal rooms with a door each along a corridor.
    void drawRooms() {
        const double step = between(3, 5), depth = between(3, 5), width = between(1.6, 2.5),
                     gap = between(0.8, 1.1), at = between(0.4, 1.5), inner = width + 0.1;
        const int count = oneOf(4, 7);
        std::vector<Point> outline{{0, 0}, {count * step, 0}, {count * step, width}};
        for (int i = count; i-- > 0;) {
            const double x = i * step, door = x + at, far = x + step - 0.1;
            for (const Point p : {Point(door + gap, width), Point(door + gap, inner), Point(far, inner),
                                  Point(far, width + depth), Point(x, width + depth), Point(x, inner),
                                  Point(door, inner), Point(door, width)})
                outline.push_back(p);
        }
        outline.emplace_back(0, width);
        close(outline);
    }
    vectorlib::Pose2D place(double x, double y, double reach) {
        const double px = x + between(-reach, reach), py = y + between(-reach, reach);
        return {px, py, between(-vectorlib::pi, vectorlib::pi)};
    }
    // 30 cm from all edges, and inside by the number of edges to the right.
    bool isFree(Point p) const {
        bool isInside = false;
        for (const Segment &e : edges) {
            if (e.distance(p) < 0.3)
                return false;
            const Point a = e.begin(), b = e.end();
            if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
                isInside = !isInside;
        }
        return isInside;
    }

    std::mt19937_64 random_;
};
