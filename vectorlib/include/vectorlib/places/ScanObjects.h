#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Vector2D.h"

#include <array>
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
    void number(const std::vector<LineSegment2D<double>> &walls, std::vector<WallPoint> &points);

private:
    using Vector = Vector2D<double>;
    using Wall = LineSegment2D<double>;
    static constexpr double sameFacing = 0.8; // cosine between a point's wall and one it lies on, at least

    void join(const std::vector<Wall> &walls);
    bool isOne(const Wall &a, const Wall &b) const;
    int wallOf(const std::vector<Wall> &walls, const WallPoint &point) const;
    int root(int i) const;
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }

    int count_ = 0; // of walls
    std::array<int, most> parent_{};
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/places/ScanObjects.cpp")
