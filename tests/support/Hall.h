#pragma once

#include "vectorlib/correspondence/CorrespondenceFinder.h"
#include "vectorlib/observation/Observer.h"

/// A map of equal rooms side by side, as many as it takes for so many segments: of the same density whatever
/// its size. Each room is 12 m wide and has two pillars.
struct Hall {
    using Point = vectorlib::Vector2D<double>;
    using Segment = vectorlib::LineSegment2D<double>;

    vectorlib::SegmentMap map;
    Point middle; ///< of the middle room

    explicit Hall(std::size_t segments) {
        const int side = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(segments) / 12)));
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const Point at(15.0 * i, 15.0 * j);
                addSquare(segments, at, 6, true);
                addSquare(segments, at + Point(2.5, 1), 0.4, false);
                addSquare(segments, at + Point(-1, -3), 0.6, false);
            }
        middle = Point(15.0 * (side / 2), 15.0 * (side / 2));
    }

    /// What a sensor sees from a pose in the middle room, without noise.
    std::vector<Segment> view(const vectorlib::Pose2D &pose) {
        std::vector<Segment> around, seen;
        for (int number : map.near(middle, 8))
            around.push_back(map[number]);
        vectorlib::Observer<double> observe;
        for (const auto &part : observe(around, pose))
            seen.push_back(part.segment);
        return seen;
    }

private:
    void addSquare(std::size_t most, Point at, double half, bool isRoom) {
        const Point c[] = {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
        for (std::size_t i = 0; i < 4 && map.size() < most; ++i) {
            const Segment side(at + c[i], at + c[(i + 1) % 4]);
            map.add(isRoom ? side : side.reversed());
        }
    }
};
