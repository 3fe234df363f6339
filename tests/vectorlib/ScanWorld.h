#pragma once

#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/mapping/TimedScan.h"

/// Walls and round things, and what a scanner sees of them.
struct ScanWorld {
    using Points = std::vector<vectorlib::Vector2D<float>>;
    using Point = vectorlib::Vector2D<double>;

    struct Circle {
        Point centre;
        double radius = 0;
    };
    struct Scanner {
        int rays = 361;
        double fieldOfView = vectorlib::pi; ///< about straight ahead; radians
        double sigma = 0.01;                ///< of the ranges; metres
        double reach = 80;                  ///< nothing is seen farther away; metres
    };
    std::vector<vectorlib::LineSegment2D<double>> walls;
    std::vector<Circle> pillars;

    /// A world with a closed wall through these corners.
    static ScanWorld of(const std::vector<Point> &corners) {
        ScanWorld w;
        for (std::size_t i = 0; i < corners.size(); ++i)
            w.walls.emplace_back(corners[i], corners[(i + 1) % corners.size()]);
        return w;
    }
    static ScanWorld room() { return of({{-4, -3}, {4, -3}, {4, 3}, {-1, 3}, {-4, 1}}); }
    static ScanWorld corridor() { return {{{{-40, -1}, {40, -1}}, {{40, 1}, {-40, 1}}}, {}}; }
    /// Round pillars only: no line is longer than a few points.
    static ScanWorld grove() {
        ScanWorld w;
        std::mt19937 random(5);
        std::uniform_real_distribution<double> x(1, 9), y(-7, 7), radius(0.1, 0.35);
        for (int i = 0; i < 40; ++i)
            w.pillars.push_back({{x(random), y(random)}, radius(random)});
        return w;
    }

    Points scan(const vectorlib::Transformation2D &pose, std::mt19937 &random) const {
        return scan(pose, random, Scanner());
    }
    Points scan(const vectorlib::Transformation2D &pose, std::mt19937 &random, const Scanner &scanner) const {
        return see(pose, random, scanner, [this](Point from, Point ray) { return range(from, ray); });
    }
    /// The same, with a function that gives how far a ray goes from a point.
    template <typename Range>
    static Points see(const vectorlib::Transformation2D &pose, std::mt19937 &random, const Scanner &scanner,
                      const Range &range) {
        std::normal_distribution<double> noise;
        Points points;
        for (int i = 0; i < scanner.rays; ++i) {
            const double angle = scanner.fieldOfView * (double(i) / (scanner.rays - 1) - 0.5);
            const Point ray(std::cos(angle), std::sin(angle));
            const double r = range(pose.translation(), pose.rotate(ray));
            if (r < scanner.reach)
                points.emplace_back(ray * (r + scanner.sigma * noise(random)));
        }
        return points;
    }
    /// How far a ray goes from a point to a wall, 1e9 where it meets none; metres.
    static double rangeOf(const vectorlib::LineSegment2D<double> &wall, Point from, Point ray) {
        const double across = ray.cross(wall.direction());
        const double r = (wall.begin() - from).cross(wall.direction()) / across;
        const double t = wall.along(from + ray * r);
        return r > 0 && t >= 0 && t <= wall.length() ? r : 1e9;
    }

private:
    double range(Point from, Point ray) const {
        double nearest = 1e9;
        for (const auto &wall : walls)
            nearest = std::min(nearest, rangeOf(wall, from, ray));
        for (const Circle &c : pillars) {
            const double along = (c.centre - from).dot(ray), across = (c.centre - from).cross(ray);
            const double depth = c.radius * c.radius - across * across;
            if (depth > 0 && along - std::sqrt(depth) > 0)
                nearest = std::min(nearest, along - std::sqrt(depth));
        }
        return nearest;
    }
};

/// A scan with the pose that wheels tell of it.
inline vectorlib::TimedScan timedScan(ScanWorld::Points points, const ScanWorld::Scanner &scanner,
                                      double stamp, const vectorlib::Pose2D &wheels) {
    vectorlib::TimedScan scan;
    scan.points = std::move(points);
    scan.stamp = stamp;
    scan.odometry.emplace(0, std::vector<vectorlib::OdometrySample>{{stamp, wheels, {}, {}}});
    scan.rays = std::size_t(scanner.rays);
    scan.fieldOfView = scanner.fieldOfView;
    scan.closed = false;
    return scan;
}
