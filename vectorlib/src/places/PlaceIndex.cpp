#include "vectorlib/places/PlaceIndex.h"

#include <utility>

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
    index_.build(points, maxRead);
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
        for (double k = 0.5; k < count && points_.size() < maxRead; ++k)
            points_.push_back({Vector2D<float>(wall.begin() + wall.direction() * (wall.length() * k / count)),
                               Vector2D<float>(wall.direction())});
    }
}

VECTORLIB_BODY void PlaceScan::thin() {
    const std::size_t most = maxPoints, n = points_.size();
    wallOfPoint_ = spacing * std::max(1.0, double(n) / double(std::max<std::size_t>(1, most)));
    if (n <= most)
        return;
    for (std::size_t k = 0; k < most; ++k)
        points_[k] = points_[k * n / most];
    points_.resize(most);
}

VECTORLIB_BODY void PlaceIndex::clear() {
    PlaceIndex empty;
    empty.tiles_.maxEntries = tiles_.maxEntries;
    *this = std::move(empty);
}

VECTORLIB_BODY void PlaceIndex::set(int number, const Wall *wall) {
    const auto at = static_cast<std::size_t>(number);
    if (wall && !(wall->isFinite() && wall->length() > 0))
        wall = nullptr; // nobody can see it
    if (at >= walls_.size() && wall)
        walls_.resize(at + 1);
    if (at >= walls_.size())
        return;
    const Known &known = walls_[at];
    const bool isDone = known.isUsed || !isUsable(known.wall);
    if (known.there && wall && isDone && known.wall.begin() == wall->begin() &&
        known.wall.end() == wall->end())
        return;
    if (known.there)
        remove(number);
    if (wall)
        add(number, *wall);
}

VECTORLIB_BODY void PlaceIndex::add(int number, const Wall &wall) {
    const bool isUsed = isUsable(wall) && tiles_.add(number, wall);
    ++size_;
    leftOut_ += !isUsed;
    walls_[static_cast<std::size_t>(number)] = {true, isUsed, wall, isUsed ? alike(wall).size() : 0};
    if (isUsed)
        alike(wall).push_back(number);
}

VECTORLIB_BODY void PlaceIndex::remove(int number) {
    Known &known = walls_[static_cast<std::size_t>(number)];
    known.there = false;
    --size_;
    leftOut_ -= !known.isUsed;
    if (!known.isUsed)
        return;
    std::vector<int> &numbers = alike(known.wall);
    walls_[static_cast<std::size_t>(numbers.back())].place = known.place;
    numbers[known.place] = numbers.back();
    numbers.pop_back();
    tiles_.remove(number);
}

} // namespace vectorlib
