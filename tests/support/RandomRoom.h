#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include <random>
#include <vector>

/// A room of made-up shape with obstacles, and two poses inside; metres, free space on the left.
struct RandomRoom {
    using Point = vectorlib::Vector2D<double>;
    using Segment = vectorlib::LineSegment2D<double>;

    std::vector<Segment> edges; ///< 5 to 30
    vectorlib::Pose2D first, second;

    explicit RandomRoom(std::uint64_t seed)
        : random_(seed) {
        const std::size_t count = 5 + random_() % 26;
        addWalls(std::min<std::size_t>(count, 5 + random_() % 6));
        first = {uniform(-0.5, 0.5), uniform(-0.5, 0.5), uniform(-3, 3)};
        const vectorlib::Transformation2D motion(uniform(-0.9, 0.9), uniform(-0.9, 0.9), uniform(-0.9, 0.9));
        second = (vectorlib::Transformation2D(first) * motion).pose();
        for (int tries = 0; edges.size() + 3 <= count && tries < 1000; ++tries)
            addObstacle(count - edges.size());
    }

private:
    double uniform(double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random_);
    }
    void close(const std::vector<Point> &corners) {
        for (std::size_t i = 0; i < corners.size(); ++i)
            edges.emplace_back(corners[i], corners[(i + 1) % corners.size()]);
    }
    // Counter-clockwise about the origin, nowhere nearer than 2.2 m.
    void addWalls(std::size_t count) {
        std::vector<Point> corners;
        for (std::size_t i = 0; i < count; ++i) {
            const double angle = 2 * vectorlib::pi * (double(i) + uniform(-0.3, 0.3)) / double(count);
            corners.push_back(Point(std::cos(angle), std::sin(angle)) * uniform(4, 8));
        }
        close(corners);
    }
    // A triangle or quadrangle, clockwise, that touches nothing and leaves both poses free.
    void addObstacle(std::size_t most) {
        const Point middle(uniform(-5, 5), uniform(-5, 5));
        const double radius = uniform(0.25, 0.6);
        for (const Segment &edge : edges)
            if (edge.distance(middle) < radius + 0.2 || (edges.size() > 0 && !inside(middle)))
                return;
        for (const vectorlib::Pose2D &pose : {first, second})
            if ((Point(pose.x, pose.y) - middle).norm() < radius + 0.3)
                return;
        const std::size_t sides = most >= 4 && random_() % 2 ? 4 : 3;
        const double start = uniform(0, 6);
        std::vector<Point> corners;
        for (std::size_t i = 0; i < sides; ++i) {
            const double angle = start - 2 * vectorlib::pi * (double(i) + uniform(-0.2, 0.2)) / double(sides);
            corners.push_back(middle + Point(std::cos(angle), std::sin(angle)) * radius);
        }
        close(corners);
    }
    // Of the walls, by the number of edges to the right: even outside or in an obstacle.
    bool inside(Point p) const {
        bool result = false;
        for (const Segment &e : edges)
            if ((e.begin().y > p.y) != (e.end().y > p.y) &&
                p.x <
                    e.begin().x + (p.y - e.begin().y) / (e.end().y - e.begin().y) * (e.end().x - e.begin().x))
                result = !result;
        return result;
    }

    std::mt19937_64 random_;
};
