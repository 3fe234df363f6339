#include "vectorlib/mapping/ParallelTwins.h"

#include <tuple>

namespace vectorlib {

VECTORLIB_BODY const std::vector<TwinWalls> &ParallelTwins::operator()(const VectorMap &map,
                                                                       const ScanDrive &drive) {
    pairs_.clear();
    grid_.clear();
    map.forEach([this](const MapEdge &e) { grid_.insert(static_cast<int>(e.id), e.segment); });
    for (std::size_t i = 0; i < map.slots().size(); ++i)
        if (map.slots()[i].observations >= settings.minObservations)
            pairWith(map, static_cast<int>(i));
    if (!pairs_.empty())
        countWitnesses(map, drive);
    std::sort(pairs_.begin(), pairs_.end(), [](const TwinWalls &a, const TwinWalls &b) {
        const double p = std::abs(a.distance), q = std::abs(b.distance);
        return std::tie(p, a.first, a.second) < std::tie(q, b.first, b.second);
    });
    return pairs_;
}

VECTORLIB_BODY TwinShare ParallelTwins::share(const VectorMap &map, const ScanDrive &drive) {
    TwinShare result;
    map.forEach([&](const MapEdge &e) {
        if (e.observations >= settings.minObservations)
            result.walls += e.segment.length();
    });
    PartsOfWalls twins, real;
    for (const TwinWalls &pair : (*this)(map, drive)) {
        PartsOfWalls &parts = isReal(pair) ? real : twins;
        const LineSegment2D<double> &wall = map.slots()[std::size_t(pair.first)].segment;
        const LineSegment2D<double> &other = map.slots()[std::size_t(pair.second)].segment;
        const LineSegment2D<double> shared = wall.part(pair.from, pair.to);
        parts[pair.first].emplace_back(pair.from, pair.to);
        parts[pair.second].emplace_back(std::max(0.0, other.along(shared.begin())),
                                        std::min(other.length(), other.along(shared.end())));
    }
    result.twins = lengthOf(twins);
    result.real = lengthOf(real);
    return result;
}

VECTORLIB_BODY double ParallelTwins::lengthOf(PartsOfWalls &walls) {
    double sum = 0;
    for (auto &[number, parts] : walls) {
        std::sort(parts.begin(), parts.end());
        double end = 0;
        for (const auto &[from, to] : parts) {
            sum += std::max(0.0, to - std::max(from, end));
            end = std::max(end, to);
        }
    }
    return sum;
}

VECTORLIB_BODY void ParallelTwins::pairWith(const VectorMap &map, int number) {
    const LineSegment2D<double> &wall = map.slots()[std::size_t(number)].segment;
    grid_.query(wall, settings.most, [&](int other) {
        const std::int64_t a = map.slots()[std::size_t(number)].observations;
        const std::int64_t b = map.slots()[std::size_t(other)].observations;
        if (b >= settings.minObservations && (b < a || (b == a && other > number)))
            addIfTwins(map, number, other);
    });
}

VECTORLIB_BODY void ParallelTwins::addIfTwins(const VectorMap &map, int first, int second) {
    const LineSegment2D<double> &wall = map.slots()[std::size_t(first)].segment;
    const LineSegment2D<double> &other = map.slots()[std::size_t(second)].segment;
    if (wall.direction().dot(other.direction()) < std::cos(settings.maxAngle))
        return;
    TwinWalls pair{first,
                   second,
                   0,
                   std::max(0.0, wall.along(other.begin())),
                   std::min(wall.length(), wall.along(other.end())),
                   0};
    if (2 * (pair.to - pair.from) < std::min(wall.length(), other.length()) || pair.to <= pair.from)
        return;
    const Vector2D<double> middle = wall.begin() + wall.direction() * ((pair.from + pair.to) / 2);
    pair.distance = -other.across(middle);
    const double apart = std::abs(pair.distance);
    if (apart >= settings.least && apart <= settings.most)
        pairs_.push_back(pair);
}

VECTORLIB_BODY void ParallelTwins::countWitnesses(const VectorMap &map, const ScanDrive &drive) {
    pairsOf_.clear();
    for (std::size_t i = 0; i < pairs_.size(); ++i)
        pairsOf_[pairs_[i].first].push_back(i);
    find_.index(map);
    for (std::size_t i = 0; i < drive.edges.size(); ++i)
        askScan(map, drive.edges[i], Transformation2D(drive.poses[i]));
}

VECTORLIB_BODY void ParallelTwins::askScan(const VectorMap &map, const std::vector<EdgeRaw2D> &edges,
                                           const Transformation2D &pose) {
    seen_.clear();
    for (const EdgeRaw2D &e : edges) {
        const LineSegment2D<double> edge = pose * e.segment;
        const int number = static_cast<int>(find_(edge));
        if (number < 0)
            continue;
        const double off = map.slots()[std::size_t(number)].segment.across(edge.middle());
        Sight &sight = seen_[number];
        if (edge.length() > sight.length)
            sight = {edge.length(), off};
    }
    for (const auto &[number, sight] : seen_) {
        const auto found = pairsOf_.find(number);
        if (found == pairsOf_.end())
            continue;
        for (const std::size_t i : found->second) {
            const auto other = seen_.find(pairs_[i].second);
            if (other == seen_.end())
                continue;
            const double seen = pairs_[i].distance + other->second.off - sight.off;
            const double ratio = seen / pairs_[i].distance;
            pairs_[i].witnesses += ratio > 0.5 && ratio < 1.5;
        }
    }
}

} // namespace vectorlib
