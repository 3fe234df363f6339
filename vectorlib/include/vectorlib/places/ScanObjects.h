#pragma once

#include "vectorlib/geometry/LineSegment2D.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vectorlib {

/// A point of a scan and the direction of the wall there, free space on its left; sensor frame.
struct WallPoint {
    Vector2D<float> position;  ///< metres
    Vector2D<float> direction; ///< of unit length
    int object = 0;            ///< by ScanObjects
};

/// Tells which points of a scan lie on one and the same object, so that what they say is said once. An object
/// is a wall, or the walls that meet at corners that stick out, as those of a cupboard do; pieces of one line
/// are one wall.
class ScanObjects {
public:
    static constexpr int most = 63; ///< objects; the last one is all further ones
    double meeting = 0.25;          ///< between the ends of walls that meet; metres
    double sticksOut = 0.3;         ///< sine of the angle at such a corner, at least
    double beside = 0.1;            ///< a point lies on a wall so near; metres
    double sameLine = 0.985;        ///< cosine between pieces of one line, at least
    double gap = 0.3;               ///< between points of one object that is no wall; metres

    /// Walls with the most telling first, points counter-clockwise; both in the sensor's frame.
    void number(const std::vector<LineSegment2D<double>> &walls, std::vector<WallPoint> &points) {
        count_ = static_cast<int>(std::min<std::size_t>(walls.size(), most));
        join(walls);
        int next = count_;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const int wall = wallOf(walls, points[i]);
            if (wall >= 0)
                points[i].object = root(wall);
            else if (i > 0 && (points[i].position - points[i - 1].position).norm() < gap)
                points[i].object = points[i - 1].object;
            else
                points[i].object = std::min(next++, most - 1);
        }
        // What of an object was seen before its wall.
        for (std::size_t i = points.size(); i-- > 1;)
            if (points[i - 1].object >= count_ && (points[i].position - points[i - 1].position).norm() < gap)
                points[i - 1].object = points[i].object;
    }

private:
    using Vector = Vector2D<double>;
    using Wall = LineSegment2D<double>;
    static constexpr double sameFacing = 0.8; // cosine between a point's wall and one it lies on, at least

    void join(const std::vector<Wall> &walls) {
        for (int i = 0; i < count_; ++i)
            parent_[at(i)] = i;
        for (int i = 0; i < count_; ++i)
            for (int j = 0; j < count_; ++j)
                if (i != j && isOne(walls[at(i)], walls[at(j)]))
                    parent_[at(root(i))] = root(j);
    }
    bool isOne(const Wall &a, const Wall &b) const {
        if ((b.begin() - a.end()).squaredNorm() < meeting * meeting &&
            a.direction().cross(b.direction()) < -sticksOut)
            return true;
        return a.direction().dot(b.direction()) > sameLine &&
               std::max(std::abs(a.across(b.begin())), std::abs(a.across(b.end()))) < beside;
    }
    int wallOf(const std::vector<Wall> &walls, const WallPoint &point) const {
        const Vector p(point.position), direction(point.direction);
        int best = -1;
        double least = beside;
        for (int i = 0; i < count_; ++i) {
            const Wall &wall = walls[at(i)];
            const double across = std::abs(wall.across(p)), along = wall.along(p);
            if (across < least && along > -beside && along < wall.length() + beside &&
                wall.direction().dot(direction) > sameFacing) {
                least = across;
                best = i;
            }
        }
        return best;
    }
    int root(int i) const {
        while (parent_[at(i)] != i)
            i = parent_[at(i)];
        return i;
    }
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }

    int count_ = 0; // of walls
    std::array<int, most> parent_{};
};

} // namespace vectorlib
