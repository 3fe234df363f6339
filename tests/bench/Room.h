#pragma once

#include <vectorlib/geometry/LineSegment2D.h>

#include <random>
#include <vector>

using Corners = std::vector<vectorlib::Vector2D<double>>;

/// A room of eleven walls around the origin; begins behind the scanner, where the scan begins and ends.
inline Corners plainRoom() {
    return {{-5, 0},   {-5, -3}, {-1, -3}, {-1, -4}, {3, -4}, {3, -2.5},
            {6, -2.5}, {6, 3},   {1.5, 3}, {1.5, 4}, {-5, 4}};
}

/// A hall of fifty walls, as folded as a paper screen, all in sight of the origin.
inline Corners foldedHall() {
    Corners corners;
    for (int i = 0; i < 50; ++i) {
        const double angle = -3.14159265 + 6.2831853 * i / 50, radius = i % 2 ? 5 : 4;
        corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return corners;
}

/// The scan of walls by a scanner at the origin, counter-clockwise, at even steps of the angle, with 1 cm
/// noise of the range: one continuous cluster. Other seeds give other noise.
inline std::vector<vectorlib::Vector2D<float>> roomScan(int rays, const Corners &corners = plainRoom(),
                                                        unsigned seed = 1) {
    using Point = vectorlib::Vector2D<double>;
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 0.01);
    std::vector<vectorlib::Vector2D<float>> points;
    for (int i = 0; i < rays; ++i) {
        const double angle = -3.14159265 + 6.2831853 * i / rays;
        const Point direction(std::cos(angle), std::sin(angle));
        double range = 100;
        for (std::size_t c = 0; c < corners.size(); ++c) {
            const Point begin = corners[c], edge = corners[(c + 1) % corners.size()] - begin;
            const double across = direction.cross(edge);
            const double distance = begin.cross(edge) / across, along = begin.cross(direction) / across;
            if (distance > 0 && along > -1e-9 && along < 1 + 1e-9)
                range = std::min(range, distance);
        }
        points.emplace_back(direction * (range + noise(random)));
    }
    return points;
}

/// Scans of such walls from places within 30 cm of the origin.
inline std::vector<std::vector<vectorlib::Vector2D<float>>> roomScans(int scans, int rays,
                                                                      const Corners &corners) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> step(-0.2, 0.2);
    std::vector<std::vector<vectorlib::Vector2D<float>>> result;
    for (int i = 0; i < scans; ++i) {
        const vectorlib::Vector2D<double> place(step(random), step(random));
        Corners seen = corners;
        for (auto &corner : seen)
            corner = corner - place;
        result.push_back(roomScan(rays, seen, unsigned(i) + 1));
    }
    return result;
}
