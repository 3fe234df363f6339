#pragma once

#include <vectorlib/geometry/Pose2D.h>
#include <vectorlib/observation/Ray.h>

#include <algorithm>
#include <random>
#include <vector>

/// Floor plans at random: rooms of different widths on both sides of a corridor, each with a door and one to
/// four pieces of furniture; metres. The same seed gives the same plan.
class FloorPlan {
public:
    using Wall = vectorlib::LineSegment2D<double>;
    using Point = vectorlib::Vector2D<double>;

    FloorPlan(unsigned seed, int rooms)
        : random_(seed) {
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
    /// A place at random, 30 cm from every wall, from where all walls around show their free side.
    vectorlib::Pose2D place() {
        Point low(1e9, 1e9), high(-1e9, -1e9);
        for (const Wall &w : walls_)
            for (const Point p : {w.begin(), w.end()}) {
                low = {std::min(low.x, p.x), std::min(low.y, p.y)};
                high = {std::max(high.x, p.x), std::max(high.y, p.y)};
            }
        for (;;)
            if (const Point p(between(low.x, high.x), between(low.y, high.y)); isFree(p))
                return {p.x, p.y, between(-vectorlib::pi, vectorlib::pi)};
    }

private:
    static constexpr double thickness = 0.1;

    double between(double a, double b) { return a + (b - a) * double(random_() % 100001) / 100000; }
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
        double x = 0;
        for (int room = 0; room < rooms; ++room) {
            const double width = between(2.5, 6.5), door = between(0.3, width - 1.3), gap = between(0.8, 1.0);
            const double own = depth - between(0, 0.8);
            block(x, y, x + door, y + side * thickness);
            block(x + door + gap, y, x + width, y + side * thickness);
            block(x - thickness / 2, y + side * thickness, x + thickness / 2, y + side * depth);
            block(x + thickness / 2, y + side * own, x + width - thickness / 2, y + side * (own + thickness));
            for (int pieces = 1 + int(random_() % 4); pieces > 0; --pieces) {
                const double a = between(0.3, 1.2), b = between(0.3, 0.9);
                const double at = between(x + 0.2, x + width - a - 0.2), deep = between(0.9, own - b - 0.1);
                block(at, y + side * deep, at + a, y + side * (deep + b));
            }
            x += width;
        }
        block(x - thickness / 2, y + side * thickness, x + thickness / 2, y + side * depth);
        return x;
    }
    bool isFree(Point p) const {
        for (const Wall &w : walls_)
            if (w.distance(p) < 0.3)
                return false;
        for (int k = 0; k < 16; ++k) {
            const double angle = k * vectorlib::pi / 8 + 0.01;
            double nearest = 1e9;
            bool showsFront = false;
            for (const Wall &w : walls_) {
                const double t =
                    vectorlib::rayDistance({std::cos(angle), std::sin(angle)}, w.begin() - p, w.end() - p);
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
    std::vector<Wall> walls_;
};
