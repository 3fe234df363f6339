#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/PointSpan.h"
#include "vectorlib/places/ScanObjects.h"
#include "vectorlib/registration/ScanIndex.h"

#include <vector>

namespace vectorlib {

/// A scan as the search of a place needs it: its walls, the most telling first, and points that stand for
/// about as much wall each. Keeps its buffers.
class PlaceScan {
public:
    std::size_t mostPoints = 160; ///< that are compared with a map
    double spacing = 0.08;        ///< between them, at least; metres
    ScanObjects objects;

    /// Edges and points in the sensor's frame, metres; points counter-clockwise. Without points the edges
    /// stand for them. What is not finite is left out.
    void take(const std::vector<EdgeRaw2D> &edges, PointSpan<float> points);
    const std::vector<WallPoint> &points() const { return points_; }
    /// First the longest, then the longest that crosses it, then the others by length.
    const std::vector<LineSegment2D<double>> &walls() const { return walls_; }
    /// How much wall a point stands for; metres.
    double wallOfPoint() const { return wallOfPoint_; }

private:
    static constexpr std::size_t mostRead = 4000; // of a scan with more points, every n-th is read
    static constexpr double crossing = 0.5;       // sine of the angle of walls that cross

    void takeWalls(const std::vector<EdgeRaw2D> &edges);
    void takePoints(PointSpan<float> points);
    void takePointsOfWalls();
    // Keeps so many, evenly.
    void thin();

    ScanIndex index_;
    std::vector<WallPoint> points_;
    std::vector<LineSegment2D<double>> walls_;
    double wallOfPoint_ = 0;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/places/PlaceScan.cpp")
