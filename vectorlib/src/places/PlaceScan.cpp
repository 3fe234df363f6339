#include "vectorlib/places/PlaceScan.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY void PlaceScan::take(const std::vector<EdgeRaw2D> &edges, PointSpan<float> points) {
    takeWalls(edges);
    points_.clear();
    if (points.empty())
        takePointsOfWalls();
    else
        takePoints(points);
    thin();
    objects.number(walls_, points_);
}

VECTORLIB_BODY void PlaceScan::takeWalls(const std::vector<EdgeRaw2D> &edges) {
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

VECTORLIB_BODY void PlaceScan::takePoints(PointSpan<float> points) {
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

VECTORLIB_BODY void PlaceScan::takePointsOfWalls() {
    for (const LineSegment2D<double> &wall : walls_) {
        const double count = std::clamp(std::ceil(wall.length() / spacing), 1.0, 1000.0);
        for (double k = 0.5; k < count && points_.size() < mostRead; ++k)
            points_.push_back({Vector2D<float>(wall.begin() + wall.direction() * (wall.length() * k / count)),
                               Vector2D<float>(wall.direction())});
    }
}

VECTORLIB_BODY void PlaceScan::thin() {
    const std::size_t most = mostPoints, n = points_.size();
    wallOfPoint_ = spacing * std::max(1.0, double(n) / double(std::max<std::size_t>(1, most)));
    if (n <= most)
        return;
    for (std::size_t k = 0; k < most; ++k)
        points_[k] = points_[k * n / most];
    points_.resize(most);
}

} // namespace vectorlib
