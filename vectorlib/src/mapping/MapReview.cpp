#include "vectorlib/mapping/MapReview.h"

namespace vectorlib {

VECTORLIB_BODY MapReviewCounts MapReview::operator()(VectorMap &map, const ScanDrive &drive) {
    counts_ = {};
    mergeTwins(map, drive);
    gather(map, drive);
    for (std::size_t i = 0; i < walls_.size(); ++i)
        leave(map, i);
    joinOverGaps(map);
    for (const int number : numbersOf(map))
        if (!isKnown(number))
            closeCorners(map, number);
    return counts_;
}

VECTORLIB_BODY std::vector<int> MapReview::numbersOf(const VectorMap &map) {
    std::vector<int> numbers;
    map.forEach([&](const MapEdge &e) { numbers.push_back(static_cast<int>(e.id)); });
    return numbers;
}

VECTORLIB_BODY void MapReview::mergeTwins(VectorMap &map, const ScanDrive &drive) {
    twins_.settings.minObservations = 1;
    twins_.settings.least = 0;
    twins_.settings.most = settings.mergeWithin;
    constexpr int rounds = 3; // a wall that took in another may lie beside a third
    for (int round = 0; round < rounds; ++round) {
        const std::size_t before = counts_.merged;
        for (const TwinWalls &pair : twins_(map, drive)) {
            const std::int64_t a = map.slots()[std::size_t(pair.first)].observations;
            const std::int64_t b = map.slots()[std::size_t(pair.second)].observations;
            if (a == 0 || b == 0 || twins_.isReal(pair) || isKnown(pair.first) || isKnown(pair.second))
                continue;
            map.absorb(pair.first, pair.second, a + b);
            ++counts_.merged;
        }
        if (counts_.merged == before)
            break;
    }
    for (const int number : numbersOf(map))
        if (!isKnown(number) && map.slots()[std::size_t(number)].observations > 0)
            counts_.joined += std::size_t(map.consolidate(number));
}

VECTORLIB_BODY void MapReview::gather(VectorMap &map, const ScanDrive &drive) {
    walls_ = numbersOf(map);
    walls_.erase(std::remove_if(walls_.begin(), walls_.end(), [this](int n) { return isKnown(n); }),
                 walls_.end());
    gaps_.clear();
    pieces_.clear();
    for (const int number : walls_) {
        pieces_.push_back(map.slots()[std::size_t(number)].segment);
        findGap(map, number);
    }
    for (const Gap &gap : gaps_)
        pieces_.push_back(gap.segment);
    evidence_(pieces_, drive);
    cutAtBegin_.assign(map.slots().size(), false);
    cutAtEnd_.assign(map.slots().size(), false);
}

VECTORLIB_BODY void MapReview::findGap(VectorMap &map, int number) {
    const LineSegment2D<double> wall = map.slots()[std::size_t(number)].segment;
    const Vector2D<double> margin(settings.widestGap, settings.widestGap);
    Gap nearest;
    double least = settings.widestGap;
    for (const int other : map.near(wall.end() - margin, wall.end() + margin)) {
        const LineSegment2D<double> &next = map.slots()[std::size_t(other)].segment;
        const double gap = wall.along(next.begin()) - wall.length();
        if (other == number || isKnown(other) || gap < 0 ||
            gap > std::min({least, wall.length(), next.length()}) ||
            next.direction().dot(wall.direction()) < std::cos(map.settings.joinAngle) ||
            std::abs(wall.across(next.begin())) > map.settings.joinDistance ||
            std::abs(next.across(wall.end())) > map.settings.joinDistance)
            continue;
        least = gap;
        nearest = {number, other, {wall.end(), next.begin()}};
    }
    if (nearest.before >= 0)
        gaps_.push_back(nearest);
}

VECTORLIB_BODY bool MapReview::isContradicted(double seen, double before, double after) const {
    if (before + after >= settings.mostlyThrough * seen + settings.fewestThrough)
        return true;
    const double missed = (before + 1) / (seen + before + 2);
    return after >= settings.fewestLater && std::pow(missed, after) < settings.unlikely;
}

VECTORLIB_BODY void MapReview::leave(VectorMap &map, std::size_t index) {
    const int number = walls_[index];
    const MapEdge wall = map.slots()[std::size_t(number)];
    const std::size_t count = evidence_.parts(index);
    const double part = wall.segment.length() / double(count);
    double seen = 0, before = 0, after = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const PartEvidence &e = evidence_.part(index, k);
        seen += e.seen;
        before += e.throughBefore;
        after += e.throughAfter;
    }
    left_.clear();
    if (!isContradicted(seen / double(count), before / double(count), after / double(count)))
        findLeft(index, count, part);
    double kept = 0;
    for (const auto &[from, to] : left_)
        kept += to - from;
    if (kept >= wall.segment.length() - 1e-9)
        return;
    counts_.contradicted += wall.segment.length() - kept;
    ++(left_.empty() ? counts_.removed : counts_.cut);
    if (left_.empty()) {
        map.remove(number);
        return;
    }
    cutAtBegin_[std::size_t(number)] = left_.front().first > 0;
    cutAtEnd_[std::size_t(number)] = left_.back().second < wall.segment.length();
    divide(map, wall);
}

VECTORLIB_BODY void MapReview::findLeft(std::size_t index, std::size_t count, double part) {
    std::size_t begin = 0; // of what stays
    const auto stay = [&](std::size_t end) {
        if (double(end - begin) * part >= settings.shortestLeft || end - begin == count)
            left_.emplace_back(double(begin) * part, double(end) * part);
    };
    for (std::size_t k = 0; k < count;) {
        std::size_t end = k;
        while (end < count && isContradicted(evidence_.part(index, end)))
            ++end;
        if (double(end - k) * part >= settings.shortestGone) {
            stay(k);
            begin = end;
        }
        k = std::max(end, k + 1);
    }
    stay(count);
}

VECTORLIB_BODY void MapReview::divide(VectorMap &map, const MapEdge &wall) {
    std::sort(left_.begin(), left_.end(),
              [](const auto &a, const auto &b) { return a.second - a.first > b.second - b.first; });
    for (std::size_t i = 0; i < left_.size(); ++i) {
        EdgeRaw2D piece = wall;
        piece.segment = wall.segment.part(left_[i].first, left_[i].second);
        piece.sums = shareOf(wall, piece.segment);
        if (i == 0)
            map.replace(static_cast<int>(wall.id), piece);
        else
            map.add(piece, wall.observations);
    }
}

VECTORLIB_BODY TlsSums MapReview::shareOf(const MapEdge &wall, const LineSegment2D<double> &piece) {
    const Vector2D<double> u = wall.segment.direction(), v = u.left();
    const double share = piece.length() / wall.segment.length();
    const TlsSums &s = wall.sums;
    const double across = (v.x * v.x * s.xx + 2 * v.x * v.y * s.xy + v.y * v.y * s.yy) * share;
    TlsSums result;
    result.n = s.n * share;
    result.mean = piece.middle();
    const double along = result.n * piece.length() * piece.length() / 12;
    result.xx = u.x * u.x * along + v.x * v.x * across;
    result.xy = u.x * u.y * along + v.x * v.y * across;
    result.yy = u.y * u.y * along + v.y * v.y * across;
    return result;
}

VECTORLIB_BODY void MapReview::joinOverGaps(VectorMap &map) {
    std::vector<int> partOf(map.slots().size());
    for (std::size_t i = 0; i < partOf.size(); ++i)
        partOf[i] = static_cast<int>(i);
    const auto rootOf = [&](int number) {
        while (partOf[std::size_t(number)] != number)
            number = partOf[std::size_t(number)];
        return number;
    };
    for (std::size_t i = 0; i < gaps_.size(); ++i) {
        const Gap &gap = gaps_[i];
        const int a = rootOf(gap.before), b = rootOf(gap.behind);
        const MapEdge &before = map.slots()[std::size_t(a)], &behind = map.slots()[std::size_t(b)];
        if (a == b || before.observations == 0 || behind.observations == 0 ||
            cutAtEnd_[std::size_t(gap.before)] || cutAtBegin_[std::size_t(gap.behind)] ||
            isSeenThrough(walls_.size() + i) || merged(before, behind).sigma > map.settings.maxSigma)
            continue;
        map.absorb(a, b, std::max(before.observations, behind.observations));
        partOf[std::size_t(b)] = a;
        ++counts_.joined;
    }
}

VECTORLIB_BODY bool MapReview::isSeenThrough(std::size_t index) const {
    for (std::size_t k = 0; k < evidence_.parts(index); ++k)
        if (evidence_.part(index, k).through() > 0)
            return true;
    return false;
}

VECTORLIB_BODY void MapReview::closeCorners(VectorMap &map, int number) {
    const LineSegment2D<double> wall = map.slots()[std::size_t(number)].segment;
    const Vector2D<double> margin(settings.cornerReach, settings.cornerReach);
    int nearest = -1;
    Vector2D<double> corner;
    double least = settings.cornerReach;
    for (const int other : map.near(wall.end() - margin, wall.end() + margin)) {
        const LineSegment2D<double> &next = map.slots()[std::size_t(other)].segment;
        const double sine = wall.direction().cross(next.direction());
        if (other == number || isKnown(other) || std::abs(sine) < settings.leastCornerSine)
            continue;
        const double along = (next.begin() - wall.begin()).cross(next.direction()) / sine;
        const Vector2D<double> meet = wall.begin() + wall.direction() * along;
        const double far = std::max((meet - wall.end()).norm(), (meet - next.begin()).norm());
        if (far > least || along < settings.cornerReach ||
            next.along(meet) > next.length() - settings.cornerReach)
            continue;
        least = far;
        nearest = other;
        corner = meet;
    }
    if (nearest < 0)
        return;
    const LineSegment2D<double> next = map.slots()[std::size_t(nearest)].segment;
    map.reshape(number, {wall.begin(), corner, wall.direction()});
    map.reshape(nearest, {corner, next.end(), next.direction()});
    ++counts_.corners;
}

} // namespace vectorlib
