#include "vectorlib/places/ScanObjects.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY void ScanObjects::number(const std::vector<LineSegment2D<double>> &walls,
                                        std::vector<WallPoint> &points) {
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

VECTORLIB_BODY void ScanObjects::join(const std::vector<Wall> &walls) {
    for (int i = 0; i < count_; ++i)
        parent_[at(i)] = i;
    for (int i = 0; i < count_; ++i)
        for (int j = 0; j < count_; ++j)
            if (i != j && isOne(walls[at(i)], walls[at(j)]))
                parent_[at(root(i))] = root(j);
}

VECTORLIB_BODY bool ScanObjects::isOne(const Wall &a, const Wall &b) const {
    if ((b.begin() - a.end()).squaredNorm() < meeting * meeting &&
        a.direction().cross(b.direction()) < -sticksOut)
        return true;
    return a.direction().dot(b.direction()) > sameLine &&
           std::max(std::abs(a.across(b.begin())), std::abs(a.across(b.end()))) < beside;
}

VECTORLIB_BODY int ScanObjects::wallOf(const std::vector<Wall> &walls, const WallPoint &point) const {
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

VECTORLIB_BODY int ScanObjects::root(int i) const {
    while (parent_[at(i)] != i)
        i = parent_[at(i)];
    return i;
}

} // namespace vectorlib
