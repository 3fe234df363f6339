#pragma once

#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/places/ScanObjects.h"
#include "vectorlib/registration/ScanIndex.h"

#include <algorithm>
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
    void take(const std::vector<EdgeRaw2D> &edges, PointSpan<float> points) {
        takeWalls(edges);
        points_.clear();
        if (points.empty())
            takePointsOfWalls();
        else
            takePoints(points);
        thin();
        objects.number(walls_, points_);
    }
    const std::vector<WallPoint> &points() const { return points_; }
    /// First the longest, then the longest that crosses it, then the others by length.
    const std::vector<LineSegment2D<double>> &walls() const { return walls_; }
    /// How much wall a point stands for; metres.
    double wallOfPoint() const { return wallOfPoint_; }

private:
    static constexpr std::size_t mostRead = 4000; // of a scan with more points, every n-th is read
    static constexpr double crossing = 0.5;       // sine of the angle of walls that cross

    void takeWalls(const std::vector<EdgeRaw2D> &edges) {
        walls_.clear();
        for (const EdgeRaw2D &edge : edges)
            if (edge.segment.isFinite() && edge.segment.length() > 0)
                walls_.push_back(edge.segment);
        const auto isLonger = [](const auto &a, const auto &b) { return a.length() > b.length(); };
        std::sort(walls_.begin(), walls_.end(), isLonger);
        const auto across = std::find_if(walls_.begin(), walls_.end(), [this](const auto &wall) {
            return std::abs(wall.direction().cross(walls_.front().direction())) > crossing;
        });
        if (across != walls_.end())
            std::rotate(walls_.begin() + 1, across, across + 1);
    }
    void takePoints(PointSpan<float> points) {
        index_.build(points, mostRead);
        Vector2D<float> last(1e9f, 1e9f);
        const float least = static_cast<float>(spacing * spacing);
        for (int i = 0; i < index_.size(); ++i) {
            const Vector2D<float> p = index_.point(i), n = index_.normal(i);
            if (n.squaredNorm() < 0.5f || (p - last).squaredNorm() < least)
                continue;
            points_.push_back({p, -n.left()});
            last = p;
        }
    }
    void takePointsOfWalls() {
        for (const LineSegment2D<double> &wall : walls_) {
            const double count = std::clamp(std::ceil(wall.length() / spacing), 1.0, 1000.0);
            for (double k = 0.5; k < count && points_.size() < mostRead; ++k)
                points_.push_back(
                    {Vector2D<float>(wall.begin() + wall.direction() * (wall.length() * k / count)),
                     Vector2D<float>(wall.direction())});
        }
    }
    // Keeps so many, evenly.
    void thin() {
        const std::size_t most = mostPoints, n = points_.size();
        wallOfPoint_ = spacing * std::max(1.0, double(n) / double(std::max<std::size_t>(1, most)));
        if (n <= most)
            return;
        for (std::size_t k = 0; k < most; ++k)
            points_[k] = points_[k * n / most];
        points_.resize(most);
    }

    ScanIndex index_;
    std::vector<WallPoint> points_;
    std::vector<LineSegment2D<double>> walls_;
    double wallOfPoint_ = 0;
};

} // namespace vectorlib
