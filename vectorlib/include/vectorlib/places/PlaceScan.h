#pragma once

#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/places/Corner.h"
#include "vectorlib/registration/ScanIndex.h"

#include <vector>

namespace vectorlib {

/// A point of a scan and the direction of the wall there, free space on its left; sensor frame.
struct WallPoint {
    Vector2D<float> position;
    Vector2D<float> direction;
};

struct PlaceScanSettings {
    std::size_t mostPoints = 160;  ///< of a scan that are compared with a map
    double spacing = 0.08;         ///< between such points; metres
    std::size_t mostWalls = 40;    ///< whose corners are taken, the longest
    std::size_t mostCorners = 60;  ///< best first
    CornerSettings corner;
};

/// A scan as the search of a place needs it: points that stand for about as much wall each, and the corners
/// of its walls, the best first. Keeps its buffers.
class PlaceScan {
public:
    PlaceScanSettings settings;

    /// Edges and points in the sensor's frame, points counter-clockwise. Without points the edges stand for
    /// them.
    void take(const std::vector<EdgeRaw2D> &edges, PointSpan<float> points) {
        takeWalls(edges);
        points_.clear();
        if (points.empty())
            takePointsOfWalls();
        else
            takePoints(points);
        thin();
        findCorners();
    }
    const std::vector<WallPoint> &points() const { return points_; }
    const std::vector<LineSegment2D<double>> &walls() const { return walls_; }
    const std::vector<Corner> &corners() const { return corners_; }

private:
    static constexpr std::size_t mostRead = 4000; // of a scan with more points, every n-th is read

    void takeWalls(const std::vector<EdgeRaw2D> &edges) {
        walls_.clear();
        for (const EdgeRaw2D &edge : edges)
            if (edge.segment.isFinite() && edge.segment.length() > 0)
                walls_.push_back(edge.segment);
        std::stable_sort(walls_.begin(), walls_.end(),
                         [](const auto &a, const auto &b) { return a.length() > b.length(); });
    }
    void takePoints(PointSpan<float> points) {
        index_.build(points, mostRead);
        Vector2D<float> last(INFINITY, INFINITY);
        const float spacing = float(settings.spacing);
        for (int i = 0; i < index_.size(); ++i) {
            const Vector2D<float> p = index_.point(i), n = index_.normal(i);
            if (n.squaredNorm() < 0.5f || (p - last).squaredNorm() < spacing * spacing)
                continue;
            points_.push_back({p, -n.left()});
            last = p;
        }
    }
    void takePointsOfWalls() {
        for (const LineSegment2D<double> &wall : walls_) {
            const double count = std::clamp(std::ceil(wall.length() / settings.spacing), 1.0, 1000.0);
            for (double k = 0.5; k < count && points_.size() < mostRead; ++k)
                points_.push_back({Vector2D<float>(wall.begin() + wall.direction() * (wall.length() * k / count)),
                                   Vector2D<float>(wall.direction())});
        }
    }
    // Keeps so many, evenly.
    void thin() {
        const std::size_t most = settings.mostPoints, n = points_.size();
        if (n <= most)
            return;
        for (std::size_t k = 0; k < most; ++k)
            points_[k] = points_[k * n / most];
        points_.resize(most);
    }
    // Long walls that reach their corner tell most.
    static double worth(const Corner &c) {
        const auto known = [](const Corner::Side &s) { return std::min(s.length(), 2.0); };
        const double one = known(c.first), other = known(c.second);
        return std::min(one, other) + 0.5 * std::max(one, other) - 0.5 * c.gap();
    }
    void findCorners() {
        corners_.clear();
        const std::size_t n = std::min(walls_.size(), settings.mostWalls);
        for (std::size_t a = 0; a < n; ++a)
            for (std::size_t b = a + 1; b < n; ++b)
                if (const auto corner = cornerOf(int(a), walls_[a], int(b), walls_[b], settings.corner))
                    corners_.push_back(*corner);
        std::stable_sort(corners_.begin(), corners_.end(),
                         [](const Corner &a, const Corner &b) { return worth(a) > worth(b); });
        if (corners_.size() > settings.mostCorners)
            corners_.resize(settings.mostCorners);
    }

    ScanIndex index_;
    std::vector<WallPoint> points_;
    std::vector<LineSegment2D<double>> walls_;
    std::vector<Corner> corners_;
};

} // namespace vectorlib
